// SPDX-License-Identifier: Apache-2.0
// What makes an arm stand still, wherever who commanded it before was cut off.
#pragma once

#include <cstdint>
#include <vector>

namespace fathom {

// To be written whole, again and again: what is on a line may be lost.
struct StandStill {
    std::vector<uint8_t> bytes; // end whatever telegram was begun, then say stop to every joint
    double period = 0.0;        // [s] between two times
};

StandStill reachStandStill(); // velocity 0, as the driver's own hold
StandStill ecaStandStill();   // a frame of holds, likewise

} // namespace fathom
