// SPDX-License-Identifier: Apache-2.0
// One exchange with a real arm: what the haptic thread wishes against what the arm may do.
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

    // An exchange that homes the arm, or holds it where it needs no homing (any more). True when it is ready.
    // Nothing looks at what the joints hit on their way to their stops.
    bool home(double now) noexcept;

    // now [s]: any monotonic clock; setpointAge [s]: of the wish, on the haptic thread's word. at and
    // reopened of the answer are the caller's.
    ArmStatus exchange(double now, const ArmSetpoint& setpoint, double setpointAge) noexcept;

    static constexpr double kSetpointStale = 0.1; // [s] a haptic thread that is silent holds the arm
    static constexpr double kBehindTime = 0.5;    // [s]
    static constexpr double kBehindOver = 0.25;   // of the lag that is allowed: it may follow again

private:
    ArmState stateOf(bool asked) const noexcept;

    ArmDevice& device_;
    ArmAxes axes_;
    ArmCommand command_;
    double lagging_ = 0.0; // [s] since when; 0 = not
    bool behind_ = false;
};

} // namespace fathom
