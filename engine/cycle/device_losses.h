// SPDX-License-Identifier: Apache-2.0
// Counts the losses of a haptic device that comes and goes.
#pragma once

#include <array>

namespace fathom {

// Three losses within kCleanTime keep the forces off until kCleanTime has passed without a loss. One thread;
// noexcept, no allocation.
class DeviceLosses {
public:
    // One tick at `time` [s]. True while forces must stay off because of losses.
    bool step(double time, bool present) noexcept;

    static constexpr double kCleanTime = 1.0; // [s]

private:
    bool present_ = true;
    std::array<double, 3> at_{-1e9, -1e9, -1e9}; // [s] the last three
    bool many_ = false;                          // until kCleanTime is clean
};

} // namespace fathom
