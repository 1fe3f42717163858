// SPDX-License-Identifier: Apache-2.0
// Measures the haptic side without a GPU: presses a tool against a wavy wall of spheres and drags it, tick by
// tick. Contact answers may be late.
#pragma once

#include "apps/profile/spread.h"
#include "engine/haptics/proxy.h"

namespace fathom::profile {

struct DragSetting {
    uint32_t leaves = 256, delay = 0;
    uint32_t ticks = 1500;      // of 1 ms each
    double reach = 0.01;        // [m]
    double speed = 0.5;         // [m/s] of the hand on its circle
    double press = 0.002;       // [m] depth of the hand below contact
    bool follow = false;        // the hand follows the wall's height, so it always presses
    ProxyOptions proxy;         // step cap, solves per tick
    double deadlineMicros = 0;  // [us] per tick; 0 = none
    double spacing = 0.00175;   // [m] of the wall's spheres, centre to centre
    const Tool* tool = nullptr; // null: a ball of `leaves` leaves
};

struct DragResult {
    CpuSamples queries, steps;
    double lagRms = 0.0;   // [m] distance of the tool behind the hand along the wall, all ticks
    double deepest = -1.0; // [m] deepest leaf in any sphere, audited ticks; < 0 = no overlap
    uint64_t stalled = 0, solves = 0, rounds = 0, contacts = 0;
    size_t spheres = 0;
    std::vector<Pose> poses; // after each tick

    // Adds the times of another run of the same setting with the same result.
    void addTimes(const DragResult& again) {
        queries.add(again.queries);
        steps.add(again.steps);
    }
};

// The hand path depends only on leaves, speed, press, follow and ticks. Brute force audits every 64th tick
// and the last.
DragResult drag(const DragSetting& setting);

} // namespace fathom::profile
