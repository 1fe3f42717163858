// SPDX-License-Identifier: Apache-2.0
// Static worlds that a hand presses into, and the loops that do it. The settling and energy cases share them.
#pragma once

#include "apps/stability/loop_rig.h"

#include <functional>

namespace fathom::stability {

enum class Ground { Wall, Corner, Slot, Spheres };
inline constexpr std::array<Ground, 4> kGrounds{Ground::Wall, Ground::Corner, Ground::Slot, Ground::Spheres};

// The tool (a 10 mm ball unless the spec has another) starts 10 mm above the surface. The hand pushes it 15
// mm past the surface at 0.1 m/s, holds, slides 20 mm along it, and holds until `seconds` [s].
LoopSpec pressedSpec(Ground ground, double seconds);

inline constexpr double kPressed = 0.9; // [s] the push and the slide have ended by then

// Devices, hands and loops that the cases run over. The short form takes every k-th combination, such that
// each value still occurs.
struct LoopGrid {
    std::vector<double> masses{0.05, 0.2, 1.0}, dampings{0.1, 0.5, 2.0}, rates{1000.0};
    std::vector<uint32_t> delays{0, 1, 3};
    std::vector<size_t> hands{1, 2, 3, 4}; // of kHands
    size_t every = 1;
};
// Calls use(spec) for each combination, with device, hand and loop set in spec. Returns the number of calls.
size_t forEachLoop(const LoopGrid& grid, const LoopSpec& base,
                   const std::function<void(const LoopSpec&)>& use);

std::string nameOf(const LoopSpec& spec);

} // namespace fathom::stability
