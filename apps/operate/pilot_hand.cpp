// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/pilot_hand.h"

#include "engine/cycle/step_record.h"
#include "engine/haptics/limits.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kPull = 35.0;    // [1/s] rate of the critically damped approach
constexpr double kLongest = 0.02; // [s] a longer period counts as this one

} // namespace

PilotHand::PilotHand(const Pose& start)
    : setpoints_(HandSample{start, 0})
    , now_(start) {}

void PilotHand::ask(const HandSample& setpoint) noexcept {
    setpoints_.back() = setpoint;
    setpoints_.publish();
}

HandSample PilotHand::read(double t) noexcept {
    setpoints_.refresh();
    const HandSample& setpoint = setpoints_.front();
    const double dt = std::clamp(t - before_, 0.0, kLongest);
    before_ = t;
    const dvec3 gap = setpoint.deviceThandle.position - now_.position;
    velocity_ += dt * (kPull * kPull * gap - 2.0 * kPull * velocity_);
    velocity_ = clampLength(velocity_, kSpeed);
    now_.position += dt * velocity_;
    const dvec3 turn = rotationLog(setpoint.deviceThandle.rotation * glm::conjugate(now_.rotation));
    const dvec3 share = clampLength(turn * std::min(1.0, kPull * dt), kTurnSpeed * dt);
    now_.rotation = glm::normalize(rotationExp(share) * now_.rotation);
    return {now_, setpoint.buttons};
}

HandSample GatedHand::read(double t) noexcept {
    HandSample sample = hand_.read(t);
    there_.store(live_ == nullptr || live_->alive(), std::memory_order_relaxed);
    sample.buttons |= extra_.load(std::memory_order_relaxed);
    if (off_.load(std::memory_order_acquire)) {
        sample.buttons |= kDeadManOpen;
    }
    return sample;
}

} // namespace fathom::operate
