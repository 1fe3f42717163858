// SPDX-License-Identifier: Apache-2.0
// A tool that is pressed against and dragged over a wavy wall of spheres, turn by turn, with contact answers
// that may come late: the haptic side under measurement. No device.
#pragma once

#include "apps/profile/spread.h"
#include "engine/haptics/proxy.h"

#include <functional>

namespace fathom::profile {

struct DragSetting {
    uint32_t leaves = 256, delay = 0;
    uint32_t ticks = 1500;      // of 1 ms
    double reach = 0.01;        // [m]
    double speed = 0.5;         // [m/s] of the hand along its circle
    double press = 0.002;       // [m] that the hand is deeper than the touch
    bool follow = false;        // the hand goes up and down with the wall: pressed all the way round
    ProxyOptions proxy;         // step cap, solves
    double deadlineMicros = 0;  // of a tick; 0 = none
    double spacing = 0.00175;   // [m] of the wall's spheres
    const Tool* tool = nullptr; // in place of a ball of `leaves` leaves
};

struct DragResult {
    CpuSamples queries, turns;
    double lagRms = 0.0;   // [m] of the tool behind the hand along the wall, over all ticks
    double deepest = -1.0; // [m] of any leaf in any sphere, over the ticks looked at; < 0 = clear
    uint64_t stalled = 0, solves = 0, rounds = 0, contacts = 0;
    size_t spheres = 0;
    std::vector<Pose> poses; // after each tick

    // Times of another run of the same setting, which did the same.
    void addTimes(const DragResult& again) {
        queries.add(again.queries);
        turns.add(again.turns);
    }
};

// The same hand path for equal settings of leaves, speed, press, follow and ticks. Every 64th tick and the
// last are judged by brute force.
DragResult drag(const DragSetting& setting);

} // namespace fathom::profile
