// SPDX-License-Identifier: Apache-2.0
// Options, input and output of one proxy tick.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/haptics/proxy_rows.h"

#include <cstdint>
#include <span>

namespace fathom {

// Motion options of a proxy, fixed at construction.
struct ProxyOptions {
    // [m/s] Where new data overlaps leaves, each pair asks for this. Oblique pairs together move the tool
    // faster, by at most the step cap in a tick.
    static constexpr double kEscapeSpeed = 1.0;
    // [m/s] A tool without an active row approaches its target at most this much faster than the target
    // moves, so a tool that lags never jumps at the hand. Exception: ProxyInput::surfaceMoved.
    static constexpr double kCatchUp = 0.2;

    double stepCap = 0.002; // [m] largest travel of a leaf centre in one solve
    uint32_t solves = 4;    // linearisations per tick, at most
    double period = 0.001;  // [s] tick
    // mu of the friction between a free tool and the regions: the tool stays while the distance that it could
    // still slide is at most mu times the one that the regions keep it from. 0 = none.
    double friction = 0.0;
    RowReduction rows;
};

// Called between solves; true ends the tick. Must not throw, lock or allocate.
struct Deadline {
    bool (*passed)(const void* context) = nullptr; // null = none
    const void* context = nullptr;
};

// Input of one tick.
struct ProxyInput {
    Pose target;               // base_T_tool (arm: base_T_tip) requested by hand and guidance
    double metricRadius = 0.1; // [m] k = sqrt(K_r / K_t); 0 (arm only): the tip's direction is free
    // The active set, which must outlive the tick; null = the scene has no regions from points. Adopt a new
    // set only when accepts() returns true; otherwise the tool could pass spheres that neither set lists.
    const ContactSet* contacts = nullptr;
    Deadline deadline;
    // The regions that press on a free tool were replaced: it may follow a surface that went back as far as
    // the step caps allow.
    bool surfaceMoved = false;
};

// The result of a tick.
struct ProxyStep {
    Pose pose; // base_T_tool or base_T_tip after the tick
    // The pose that the rows alone allow: the solution before the caps, the trust region and the joint speeds
    // cut it. Equal to `pose` when nothing was cut. The distance from here to the target is the reaction of
    // the regions; the distance from `pose` to here is lag, which has no force.
    Pose allowed;
    // By how much friction alone keeps `allowed` from the pose that the rows allow: a translation [m] and a
    // rotation vector [rad]. The reaction contains it.
    dvec3 stuck{0.0}, stuckTurn{0.0};
    bool cut = false;         // `allowed` was not reached
    bool blocked = false;     // only the exact check keeps the tool from the target: counts as a row
    bool rowsExpired = false; // `allowed` is farther away than the tangents of the active rows are accurate
    std::span<const ActiveContact> active; // valid until the next tick
    double minGap = 0.0;     // [m] smallest gap in the contact set, or its reach if none is smaller;
                             // NaN without a set
    bool contact = false;    // some row of a region or shape pushes; limits of joints do not count
    bool escape = false;     // new data overlaps a leaf (some listed pair or shape)
    bool trapped = false;    // no motion satisfies every row: held this tick, tried again at the next
    bool stalled = false;    // stopped by the trust region until the next contact set
    uint32_t solves = 0;     // linearisations
    uint32_t rounds = 0;     // solver calls with tightened rows
    uint32_t infeasible = 0; // solver calls that found no motion
    uint32_t bisected = 0;   // steps that the exact check shortened
};

} // namespace fathom
