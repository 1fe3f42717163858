// SPDX-License-Identifier: Apache-2.0
// Depth in metres as 16-bit values.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

namespace fathom {

// Least and largest of measured values.
struct ValueSpan {
    double nearest = HUGE_VAL, farthest = 0.0; // without a value: infinity and 0

    // Zero, negative values, NaN and infinity are not measured.
    void add(double value);
    void add(const ValueSpan& other);
    ValueSpan scaled(double factor) const { return {factor * nearest, factor * farthest}; }
};

// The unit [m] for depth of up to `farthest` metres: 0.1 mm or the least multiple of it with which 16 bits
// are enough, at most kCoarsestUnit.
double unitForMetres(double farthest);
// The unit [m] for frames, from the depths [m] in samples of them. It allows for depths half as large again,
// but for none beyond `ofInterest` [m], unless all samples are beyond it.
double unitForMetres(const ValueSpan& seen, double ofInterest);

// Warns when the nearest point of a recording is farther than any camera sees: its values are no metres, but
// likely of the unit that it names.
// Returns the warning; empty when there is none.
std::string doubtMetres(const std::string& file, double nearest);

// `value` in units, rounded; 0 for what is no positive finite number. What is
// too far for 16 bits becomes 0 and is counted in `beyond`.
uint16_t unitsOf(double value, double valuesPerUnit, uint64_t& beyond);

} // namespace fathom
