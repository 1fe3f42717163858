// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/simulated_hand.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

constexpr uint32_t kMinSubsteps = 4;
constexpr uint32_t kMaxSubsteps = 1000;
constexpr double kPhaseStep = 0.05; // [rad] of the hand's own oscillation a substep

bool atLeast(double value, double bound) {
    return std::isfinite(value) && value >= bound;
}

dvec3 rounded(const dvec3& v, double step) noexcept {
    return step > 0.0
               ? dvec3(std::nearbyint(v.x / step), std::nearbyint(v.y / step), std::nearbyint(v.z / step)) *
                     step
               : v;
}

} // namespace

SimulatedHand::SimulatedHand(HandPath path, SimulatedHandOptions options)
    : path_(std::move(path))
    , options_(options)
    , handle_(path_.at(0.0).deviceThandle) {
    const HandLoop& loop = options_.loop;
    if (!atLeast(loop.mass, 1e-6) || !atLeast(loop.damping, 0.0) || !atLeast(loop.stiffness, 0.0) ||
        !atLeast(options_.armLength, 1e-6) || !atLeast(options_.encoderStep, 0.0) ||
        !atLeast(options_.encoderAngle, 0.0) || options_.delayTicks > kMaxDelay) {
        throw Error("simulated hand: mass and k > 0; damping, stiffness, encoder steps >= 0; delay 0..64");
    }
}

HandSample SimulatedHand::read(double t) noexcept {
    now_ = t;
    HandSample sample;
    sample.deviceThandle.position = rounded(handle_.position, options_.encoderStep);
    sample.deviceThandle.rotation =
        options_.encoderAngle > 0.0
            ? rotationExp(rounded(rotationLog(handle_.rotation), options_.encoderAngle))
            : handle_.rotation;
    sample.buttons = path_.at(t).buttons;
    return sample;
}

void SimulatedHand::write(const Wrench& deviceWrench, double dt) noexcept {
    const bool sound = isFinite(deviceWrench.force) && isFinite(deviceWrench.torque);
    const uint32_t slots = options_.delayTicks + 1;
    pending_[written_ % slots] = sound ? deviceWrench : Wrench{};
    ++written_;
    // The slot that comes next in the ring is the oldest: written delayTicks writes ago (zero at first).
    const Wrench wrench = pending_[written_ % slots];
    if (!(dt > 0.0) || !std::isfinite(dt)) {
        return;
    }
    const HandLoop& loop = options_.loop;
    const double pace = std::max(std::sqrt(loop.stiffness / loop.mass), loop.damping / loop.mass);
    const double wanted =
        std::clamp(std::ceil(dt * pace / kPhaseStep), double{kMinSubsteps}, double{kMaxSubsteps});
    const auto substeps = static_cast<uint32_t>(wanted);
    const double h = dt / wanted;
    for (uint32_t i = 0; i < substeps; ++i) {
        substep(wrench, now_ + (i + 0.5) * h, h);
    }
    now_ += dt;
}

// Half a drift, a kick, half a drift: exact under a constant force, so that the hand sees the wrench as late
// as a sampled one is (half a period) and not earlier, and neither feeds nor brakes its own swing. The damper
// acts by its exact decay about the kick: no damping, however large, can make the step unstable. t: the
// middle of the step.
void SimulatedHand::substep(const Wrench& wrench, double t, double h) noexcept {
    const HandLoop& loop = options_.loop;
    const Pose intended = path_.at(t).deviceThandle;
    const double slowing = std::exp(-0.5 * h * loop.damping / loop.mass);
    handle_.position += 0.5 * h * velocity_;
    const dvec3 pull = loop.stiffness * (intended.position - handle_.position) + wrench.force;
    velocity_ = slowing * (slowing * velocity_ + (h / loop.mass) * pull);
    handle_.position += 0.5 * h * velocity_;

    const double kk = options_.armLength * options_.armLength;
    const dquat half = rotationExp(0.5 * h * spin_);
    const dquat middle = half * handle_.rotation;
    const dvec3 away = rotationBetween(middle, intended.rotation);
    const dvec3 twist = loop.stiffness * kk * away + wrench.torque;
    spin_ = slowing * (slowing * spin_ + (h / (loop.mass * kk)) * twist);
    handle_.rotation = glm::normalize(rotationExp(0.5 * h * spin_) * middle);
}

double SimulatedHand::energy(double t) const noexcept {
    const HandLoop& loop = options_.loop;
    const Pose intended = path_.at(t).deviceThandle;
    const double kk = options_.armLength * options_.armLength;
    const dvec3 stretch = intended.position - handle_.position;
    const dvec3 away = rotationBetween(handle_.rotation, intended.rotation);
    return 0.5 * loop.mass * (glm::dot(velocity_, velocity_) + kk * glm::dot(spin_, spin_)) +
           0.5 * loop.stiffness * (glm::dot(stretch, stretch) + kk * glm::dot(away, away));
}

} // namespace fathom
