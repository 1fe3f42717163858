// SPDX-License-Identifier: Apache-2.0
// A SpaceMouse's reports as the hidraw node gives them, and its known kinds.
// Source: report layouts and ids as stated by spacenavd and andunhh.github.io/spacemouse; checked against no
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
    std::array<int16_t, 3> shift{}, tick{}; // raw, about +-350; device axes
    uint32_t buttons = 0;                   // bit i: button i
};

// Takes one report. False when it is none of motion or buttons, or too short; the state is as before then.
// Report 1: shift, or shift and turn when 12 bytes long; 2: turn; 3: buttons.
bool takeSpaceMouseReport(std::span<const uint8_t> report, SpaceMouseState& state) noexcept;

// Whether a device with these USB numbers is one of the known kinds.
bool isSpaceMouse(uint16_t vendor, uint16_t product) noexcept;

// Raw axes to the device frame that the engine sees: x right, y away from the pilot, z up. The device's own
// are x right, y towards the pilot, z down. Each component 1 at full deflection, 0 within the dead zone.
dvec3 spaceMouseAxes(const std::array<int16_t, 3>& raw) noexcept;

} // namespace fathom
