// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_drive.h"

#include "devices/usb/falcon_kinematics.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr uint8_t kForward = 2, kCentre = 4, kMinus = 8; // of the device

} // namespace

bool FalconDrive::place(const FalconState& state, HandSample& out) noexcept {
    angles_ = FalconKinematics::anglesOf(state.encoder);
    const auto knob = state.allHomed() ? FalconKinematics::forward(angles_, knob_) : std::nullopt;
    placed_ = knob.has_value();
    knob_ = knob.value_or(FalconKinematics::kHome);
    if (placed_) {
        out.deviceThandle = {knob_, dquat(1.0, 0.0, 0.0, 0.0)};
    }
    out.buttons = ((state.buttons & kCentre) != 0 ? kGuidanceButton : 0) |
                  ((state.buttons & kMinus) != 0 ? kDeadManOpen : 0) |
                  ((state.buttons & kForward) != 0 ? kDefaultClutch : 0);
    return placed_;
}

std::array<int16_t, 3> FalconDrive::motors(const dvec3& force) const noexcept {
    const auto torques =
        placed_ && isFinite(force) ? FalconKinematics::torques(knob_, angles_, force) : std::nullopt;
    if (!torques) {
        return {};
    }
    double largest = 0.0;
    for (const double torque : *torques) {
        largest = std::max(largest, std::abs(kCommandPerTorque * torque));
    }
    const double share = largest > kFalconMotorLimit ? kFalconMotorLimit / largest : 1.0;
    std::array<int16_t, 3> commands{};
    std::transform(torques->begin(), torques->end(), commands.begin(), [share](double torque) {
        return static_cast<int16_t>(std::nearbyint(kCommandPerTorque * torque * share));
    });
    return commands;
}

} // namespace fathom
