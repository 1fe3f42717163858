// SPDX-License-Identifier: Apache-2.0
// Telegrams that stop an arm, even when the previous sender was cut off within a telegram.
#pragma once

#include "devices/serial/reach_arm.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Write it completely and repeatedly, because telegrams can be lost.
struct StandStill {
    std::vector<uint8_t> bytes; // ends a truncated telegram, then stops every joint
    double period = 0.0;        // [s] repetition period
};

StandStill reachStandStill(ReachKind kind = ReachKind::Alpha5); // velocity 0, like the driver's hold
StandStill ecaStandStill();                                     // a frame of hold commands

} // namespace fathom
