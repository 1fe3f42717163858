// SPDX-License-Identifier: Apache-2.0
// Depth in metres as 16-bit values.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace fathom {

// Of the values from one power of two to the next.
struct ValueOctave {
    double least = HUGE_VAL, largest = 0.0;
    double count = 0.0;

    void add(const ValueOctave& other);
};

// Least and largest of measured values.
struct ValueSpan {
    double nearest = HUGE_VAL, farthest = 0.0; // without a value: infinity and 0
    std::array<ValueOctave, 64> octaves{};
    double atFarthest = 0.0; // values that are the farthest one

    // Zero, negative values, NaN and infinity are not measured.
    void add(double value);
    void add(const ValueSpan& other);
    ValueSpan scaled(double factor) const;
    // The largest value up to `bound`, without those of its own power of two if one of them is beyond; 0 =
    // none.
    double farthestWithin(double bound) const;

private:
    void takeEnds(double least, double largest, double atLargest);
};

// The unit [m] for depth of up to `farthest` metres: 0.1 mm or the least multiple of it with which 16 bits
// are enough, at most kCoarsestUnit.
double unitForMetres(double farthest);
// The unit [m] for frames, from the depths [m] in samples of them. It allows for depths larger by `spare`,
// but for none beyond `ofInterest` [m], unless all samples are beyond it. If that is infinite, depths beyond
// 65 m are the background that renderers write where nothing is, unless all samples are: they do not cost the
// others their precision.
double unitForMetres(const ValueSpan& seen, double ofInterest, double spare = 1.5);

// Warns when nearly all points of a recording are farther than any camera sees: its values are no metres, but
// likely of the unit that it names. A few near values do not count: resizing makes them at the borders of
// holes. Where all others are one far value, they do: that value is the background of a renderer.
// Returns the warning; empty when there is none.
std::string metresWarning(const std::string& file, const ValueSpan& seen);

// `value` in units, rounded; 0 for what is no positive finite number. What is
// too far for 16 bits becomes 0 and is counted in `beyond`.
uint16_t unitsOf(double value, double valuesPerUnit, uint64_t& beyond);

} // namespace fathom
