// SPDX-License-Identifier: Apache-2.0
// What goes into a proxy's tick and what comes out of it.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/haptics/proxy_rows.h"

#include <cstdint>
#include <span>

namespace fathom {

// How a proxy moves; fixed when it is made.
struct ProxyOptions {
    double stepCap = 0.002;       // [m] farthest that a leaf centre travels in one solve
    uint32_t solves = 4;          // linearisations per tick, at most
    double escapePerTick = 0.001; // [m] depth given back per tick where new data lies over a leaf
    RowReduction rows;
};

// True when the tick should end: asked between solves. Must not throw, lock or allocate.
struct Deadline {
    bool (*passed)(const void* context) = nullptr; // null = none
    const void* context = nullptr;
};

// What a tick asks of the proxy.
struct ProxyInput {
    Pose target;               // base_T_tool (of an arm: base_T_tip) that the hand and guidance ask for
    double metricRadius = 0.1; // [m] k = sqrt(K_r / K_t); 0, arm only = the tip's direction is free
    // The active set, which must outlive the tick; null = the scene has no regions of points. Adopt a new set
    // only when covers() accepts it: otherwise spheres that neither set lists could lie between.
    const ContactSet* contacts = nullptr;
    Deadline deadline;
};

// The result of a tick.
struct ProxyStep {
    Pose pose;                             // base_T_tool or base_T_tip after the tick
    std::span<const ActiveContact> active; // valid until the next tick
    double minGap = 0.0;                   // [m] over the contact set; its certified reach if none is nearer
    bool contact = false;                  // some row pushed in the last solve
    bool escape = false;                   // new data lies over a leaf: some listed pair or shape overlaps
    bool trapped = false;    // no motion obeys every row: held this tick, tried again at the next
    bool stalled = false;    // cut by the trust region: waits for the next contact set
    bool uncovered = false;  // the set does not cover the leaves (see ProxyInput::contacts)
    uint32_t solves = 0;     // linearisations
    uint32_t rounds = 0;     // solver calls with tightened rows
    uint32_t infeasible = 0; // solver calls that found no motion
    uint32_t bisected = 0;   // steps that the exact check shortened
};

} // namespace fathom
