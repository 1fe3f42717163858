// SPDX-License-Identifier: Apache-2.0
// SpaceMouse reports from a hidraw node, and the known models.
// Source: report layouts and ids as stated by spacenavd and andunhh.github.io/spacemouse; not verified on
// hardware.
#pragma once

#include "engine/types/pose.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom {

// Deflection and buttons after the reports so far.
struct SpaceMouseState {
    std::array<int16_t, 3> shift{}, rotation{}; // raw, about +-350; device axes
    uint32_t buttons = 0;                       // bit i: button i
};

// Applies one report. False, with the state unchanged, when it is neither motion nor buttons or is too short.
// Report 1: shift, or shift and rotation when 12 bytes long; 2: rotation; 3: buttons.
bool takeSpaceMouseReport(std::span<const uint8_t> report, SpaceMouseState& state) noexcept;

// Whether a device with these USB numbers is a known model.
bool isSpaceMouse(uint16_t vendor, uint16_t product) noexcept;

// Converts raw axes to the engine's device frame: x right, y away from the pilot, z up. The device's own
// are x right, y towards the pilot, z down. Each component 1 at full deflection, 0 within the dead zone.
dvec3 spaceMouseAxes(const std::array<int16_t, 3>& raw) noexcept;

} // namespace fathom
