// SPDX-License-Identifier: Apache-2.0
// Figures of haptic devices, each with its source.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// Axes of the handle frame: x, y, z translation, then rotation about x, y, z. +z is the handle's long axis
// (roll).
using AxisMask = std::array<bool, 6>;

// All values at the hand, device not scaled. An empty value is unknown, never zero.
struct DevicePreset {
    std::string name;
    double stiffness = 0.0;        // [N/m] that the maker or the community renders at 1 kHz
    std::optional<double> damping; // b [N s/m], physical, of the mechanism and hand grip's worst case
    std::optional<double> rotationalStiffness; // [N m/rad]
    std::optional<double> rotationalDamping;   // b_r [N m s/rad]
    double forceLimit = 0.0;                   // [N]
    double torqueLimit = 0.0; // [N m]; of devices without torque: what `replay` may still report
    AxisMask actuated{};
    AxisMask sensed{};
    std::string source; // one or two sentences: origin of each figure, and what is an assumption
};

// Throws BadInput that lists the names.
const DevicePreset& devicePreset(const std::string& name);

// All of them, in the order of the documentation.
std::span<const DevicePreset> devicePresets();

} // namespace fathom
