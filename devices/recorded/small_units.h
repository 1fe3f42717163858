// SPDX-License-Identifier: Apache-2.0
// Units of time in which stamps may be stored where seconds are read.
#pragma once

#include <array>

namespace fathom {

// A unit of time below one second.
struct SmallUnit {
    double perSecond;
    const char* name;
};

// From the largest to the smallest.
inline constexpr std::array kSmallUnits{SmallUnit{1e3, "milliseconds"}, SmallUnit{1e6, "microseconds"},
                                        SmallUnit{1e9, "nanoseconds"}};

// The unit below a second in which this time between frames is that of a camera, 2 to 200 frames per second;
// null = none.
inline const SmallUnit* smallUnitOf(double period) {
    for (const SmallUnit& unit : kSmallUnits) {
        if (period > 0.005 * unit.perSecond && period < 0.5 * unit.perSecond) {
            return &unit;
        }
    }
    return nullptr;
}

} // namespace fathom
