// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_follower.h"

namespace fathom {

bool ArmFollower::home(double now) noexcept {
    command_.position = device_.feedback().position;
    command_.hold = device_.feedback().homed;
    device_.step(now, command_);
    return device_.feedback().homed && !device_.feedback().stale;
}

ArmState ArmFollower::stateOf(bool follow) const noexcept {
    const ArmFeedback& feedback = device_.feedback();
    return feedback.stale        ? ArmState::Silent
           : !feedback.homed     ? ArmState::NotHomed
           : feedback.overloaded ? ArmState::Overloaded
           : behind_             ? ArmState::Behind
           : follow              ? ArmState::Follows
                                 : ArmState::Held;
}

ArmStatus ArmFollower::exchange(double now, const ArmSetpoint& setpoint, double setpointAge) noexcept {
    const bool follow = !setpoint.hold && setpointAge <= kSetpointStale;
    if (setpoint.off) {
        device_.reset();
    }
    // Hold while positions are not valid: homing during a run would move blindly to the stops.
    command_.hold = !follow || behind_ || !device_.feedback().homed;
    if (command_.hold) {
        command_.position = device_.feedback().position; // also for axes without a joint
    } else {
        axes_.command(setpoint.posture, command_);
    }
    device_.step(now, command_);
    const ArmFeedback& feedback = device_.feedback();
    ArmStatus status;
    status.posture = axes_.postureOf(feedback);
    status.known = feedback.homed && !feedback.stale;
    status.age = feedback.age;
    status.damaged = feedback.damaged;
    status.lag = status.known ? axes_.lag(setpoint.posture, status.posture) : 0.0;
    const bool lags = status.known && follow && status.lag > 1.0;
    lagging_ = !lags ? 0.0 : lagging_ > 0.0 ? lagging_ : now;
    behind_ = behind_ ? !(status.known && status.lag < kBehindOver)
                      : lagging_ > 0.0 && now - lagging_ > kBehindTime;
    status.state = stateOf(follow);
    return status;
}

} // namespace fathom
