// SPDX-License-Identifier: Apache-2.0
// A linear axis with round steps: where the ticks are, what they read, where a value lies in the picture.
#pragma once

#include <string>
#include <vector>

namespace fathom {

// Maps [lo, hi] of the data to [from, to] in pixels. lo < hi.
struct PlotAxis {
    double lo = 0.0, hi = 1.0;
    double from = 0.0, to = 1.0;

    double at(double value) const { return from + (value - lo) / (hi - lo) * (to - from); }
};

// Step of 1, 2 or 5 times a power of ten that cuts a range into at most `most` parts (range > 0, most >= 1).
double roundStep(double range, int most);

struct PlotTick {
    double value;
    std::string label;
};

// The ticks of the axis, as many digits in each label as the step needs and no more.
std::vector<PlotTick> ticksOf(const PlotAxis& axis, int most);

// A number for people: four significant digits, no exponent between 0.0001 and 100000.
std::string shortNumber(double value);

// The same without trailing zeros, for values that somebody chose: "20", "0.5".
std::string roundNumber(double value);

} // namespace fathom
