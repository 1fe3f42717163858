// SPDX-License-Identifier: Apache-2.0
// Static worlds that a hand is pressed into, and the loops that press: what the cases of settling and of
// energy share.
#pragma once

#include "apps/stability/loop_rig.h"
#include "apps/stability/stability_case.h"

#include <functional>

namespace fathom::stability {

enum class Ground { Wall, Corner, Slot, Spheres };
inline constexpr std::array<Ground, 4> kGrounds{Ground::Wall, Ground::Corner, Ground::Slot, Ground::Spheres};

// The tool (a ball of 10 mm unless the spec has another) starts 10 mm above, is pushed 15 mm past the surface
// at 0.1 m/s, held, and slid 20 mm along it; then held till `seconds`.
LoopSpec pressedSpec(Ground ground, double seconds);

inline constexpr double kPressed = 0.9; // [s] by then all is pushed and slid

// Devices, hands and loops over which cases run; the shortened form takes every k-th so that each value still
// occurs.
struct LoopGrid {
    std::vector<double> masses{0.05, 0.2, 1.0}, dampings{0.1, 0.5, 2.0}, rates{1000.0};
    std::vector<uint32_t> delays{0, 1, 3};
    std::vector<size_t> hands{1, 2, 3, 4}; // of kHands
    size_t every = 1;
};
// Calls use(spec) for each; spec comes with device, hand and loop set. Returns how many.
size_t forEachLoop(const LoopGrid& grid, const LoopSpec& base,
                   const std::function<void(const LoopSpec&)>& use);

std::string nameOf(const LoopSpec& spec);

} // namespace fathom::stability
