// SPDX-License-Identifier: Apache-2.0
// Properties of haptic devices, each with its source.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// Axes of the handle frame: x, y, z translation, then rotation about x, y, z. +z is the handle's long axis
// (roll).
using AxisMask = std::array<bool, 6>;

inline constexpr double kPresetPeriod = 0.001; // [s] of the ticks at which the presets' stiffness is rendered

// All values at the hand, without the hand map's scale. Empty means unknown, not zero.
struct DevicePreset {
    std::string name;
    double stiffness = 0.0;        // [N/m] rendered at 1 kHz by the maker or the community
    std::optional<double> damping; // b [N s/m], physical damping of mechanism and grip, worst case
    std::optional<double> rotationalStiffness; // [N m/rad]
    std::optional<double> rotationalDamping;   // b_r [N m s/rad]
    double forceLimit = 0.0;                   // [N]
    double torqueLimit = 0.0; // [N m]; without torque motors: the largest residual that `replay` reports
    AxisMask actuated{};
    AxisMask sensed{};
    std::string source; // one or two sentences: origin of each figure and which are assumptions
};

// Throws BadInput with the list of names.
const DevicePreset& devicePreset(const std::string& name);
const DevicePreset* findPreset(const std::string& name); // null when there is none of this name

// All names, for messages.
std::string presetNames();

// All of them, in the order of the documentation; for tests.
std::span<const DevicePreset> devicePresets();

} // namespace fathom
