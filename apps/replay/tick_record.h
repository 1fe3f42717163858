// SPDX-License-Identifier: Apache-2.0
// Records of one haptic tick and one processed frame: plain values for all writers of `replay --out`.
#pragma once

#include "engine/cycle/step_record.h"
#include "engine/run/arm_link.h"
#include "engine/types/pose.h"
#include "engine/types/wrench.h"

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fathom {

enum class TickState : uint8_t { Off, Free, Contact, Escape, Trapped, Fading, Waiting };
constexpr uint32_t kTickStates = 7;

// The state as written in haptics.csv and frames.csv.
constexpr const char* stateName(TickState state) {
    constexpr const char* kNames[kTickStates] = {"off",     "free",   "contact", "escape",
                                                   "trapped", "fading", "waiting"};
    return kNames[static_cast<uint8_t>(state)];
}

// A value that was not measured or does not exist: "nan" in CSV, null in JSON, a gap in a plot.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// One row of haptics.csv, in column order. Poses are base_T_tool [m]. The wrench is after all limits and
// before projection on the device's axes: base axes, torque about the proxy's centre.
struct TickRecord {
    double t = 0.0; // [s] since the start of the run
    Pose device;
    Pose tool; // pose of the proxy
    Wrench wrench;
    uint32_t contacts = 0;    // rows with a positive multiplier in the last solve
    double minGap = kUnknown; // [m] smallest gap in the contact set after the step
    TickState state = TickState::Off;
    double guidance = 0.0;      // weight 0..1
    int64_t frame = -1;         // index of the frame whose set was active, -1 = none
    double sceneAge = kUnknown; // [s]
    bool stalled = false;       // the trust region limited the step
    double marginPassive = kUnknown, marginUncoupled = kUnknown;

    // Not in haptics.csv or the digest, only for summary.json.
    double stepMicros = kUnknown; // [us] compute time of the step
    bool late = false;            // ended more than one period after its due start
    uint32_t solves = 0;          // linearisations
    bool infeasible = false;      // a solve had no feasible step
    bool notFinite = false;       // a number was not finite, so there was no force
    ArmRecord arm;                // all zero without an arm
    ArmPosture armStart;          // posture at the start of the tick
    bool driven = false;          // a real arm follows
    ArmStatus armStatus;          // status of the real arm before the tick
};

// A pass of the frame cycle and its time [ms]; kUnknown when the device has no timestamps.
using PassTime = std::pair<std::string, double>;

// One row of frames.csv. The passes are those of the plan, the same in every row of a run.
struct FrameRecord {
    uint32_t index = 0; // line number in associations.txt, from 0
    double t = 0.0;     // [s] capture time in the run
    uint64_t valid = 0, forbiddenPoints = 0, spheres = 0, patches = 0, nodes = 0, guidanceCount = 0;
    double uploadMs = kUnknown;
    std::vector<PassTime> passes;
    double publishMs = kUnknown;
};

} // namespace fathom
