// SPDX-License-Identifier: Apache-2.0
// One exchange with a real arm: limits the haptic thread's setpoint to what the arm can follow.
#pragma once

#include "apps/binding/arm_axes.h"
#include "engine/run/arm_link.h"

namespace fathom {

// One thread; noexcept, no allocation, no clock of its own.
class ArmFollower {
public:
    ArmFollower(ArmDevice& device, const ArmAxes& axes)
        : device_(device)
        , axes_(axes) {}

    // An exchange that homes the arm, or holds it when no homing is needed. True when it is ready. Homing
    // does not check for collisions.
    bool home(double now) noexcept;

    // now [s]: any monotonic clock; setpointAge [s]: age of the setpoint, by the haptic thread's time stamp.
    // The caller fills `at` and `reopened` of the answer.
    ArmStatus exchange(double now, const ArmSetpoint& setpoint, double setpointAge) noexcept;

    static constexpr double kSetpointStale = 0.1; // [s] an older setpoint holds the arm
    static constexpr double kBehindTime = 0.5;    // [s]
    static constexpr double kBehindOver = 0.25; // share of the allowed lag below which the arm follows again

private:
    ArmState stateOf(bool follow) const noexcept;

    ArmDevice& device_;
    ArmAxes axes_;
    ArmCommand command_;
    double lagging_ = 0.0; // [s] when it began to lag; 0 = it does not
    bool behind_ = false;
};

} // namespace fathom
