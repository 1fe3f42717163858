// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/pilot_hand.h"

#include "engine/types/haptic_device.h"
#include "engine/types/wrench.h"

#include <algorithm>

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
    const dvec3 turn = rotationBetween(now_.rotation, setpoint.deviceThandle.rotation);
    const dvec3 share = clampLength(turn * std::min(1.0, kPull * dt), kTurnSpeed * dt);
    now_.rotation = glm::normalize(rotationExp(share) * now_.rotation);
    return {now_, setpoint.buttons};
}

GatedHand::GatedHand(HapticDevice& hand, const LiveHand* live, const ButtonBits& native,
                     const std::atomic<bool>& ends)
    : hand_(hand)
    , live_(live)
    , native_(native)
    , ends_(ends) {
    choose(native);
}

void GatedHand::choose(const ButtonBits& buttons) noexcept {
    for (size_t i = 0; i < kButtonUses; ++i) {
        chosen_[i].store(buttons[i], std::memory_order_relaxed);
    }
}

uint32_t GatedHand::buttonsOf(uint32_t raw) noexcept {
    const uint32_t before = down_.exchange(raw, std::memory_order_relaxed);
    pressed_.fetch_or(raw & ~before, std::memory_order_relaxed);
    ButtonBits chosen{};
    for (size_t i = 0; i < kButtonUses; ++i) {
        chosen[i] = chosen_[i].load(std::memory_order_relaxed);
    }
    return captures_.load(std::memory_order_relaxed) ? raw & kDeadManOpen : translated(raw, native_, chosen);
}

// The buttons of a hand that is gone do not come from the device: they hold the clutch, whatever the mapping.
HandSample GatedHand::read(double t) noexcept {
    HandSample sample = hand_.read(t);
    const bool there = live_ == nullptr || live_->alive();
    present_.store(there, std::memory_order_relaxed);
    if (there && sample.present) {
        sample.buttons = buttonsOf(sample.buttons);
    }
    sample.buttons |= extra_.load(std::memory_order_relaxed);
    if (isOff(t)) {
        sample.buttons |= kDeadManOpen;
    }
    return sample;
}

bool GatedHand::isOff(double t) noexcept {
    const uint32_t calls = calls_.load(std::memory_order_acquire);
    if (calls != callsSeen_) {
        callsSeen_ = calls;
        calledAt_ = t;
    }
    const bool off = off_.load(std::memory_order_acquire), silent = t - calledAt_ > kSilence;
    if (silent && !off) {
        silent_.store(true, std::memory_order_relaxed);
    }
    return off || silent || ends_.load(std::memory_order_relaxed);
}

} // namespace fathom::operate
