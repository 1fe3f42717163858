// SPDX-License-Identifier: Apache-2.0
// A linear axis with round steps: tick positions, tick labels, and the pixel of a value.
#pragma once

#include <string>
#include <vector>

namespace fathom {

// Maps data values [lo, hi] to pixels [from, to]. Requires lo < hi.
struct PlotAxis {
    double lo = 0.0, hi = 1.0;
    double from = 0.0, to = 1.0;

    double at(double value) const { return from + (value - lo) / (hi - lo) * (to - from); }
};

// The smallest step of 1, 2 or 5 times a power of ten that divides a range into at most `most` parts (range >
// 0, most >= 1).
double roundStep(double range, int most);

struct PlotTick {
    double value;
    std::string label;
};

// Each label has as many digits as the step needs.
std::vector<PlotTick> ticksOf(const PlotAxis& axis, int most);

// Four significant digits; no exponent between 0.0001 and 100000.
std::string shortNumber(double value);

// A number without trailing zeros, for settings: "20", "0.5".
std::string roundNumber(double value);

} // namespace fathom
