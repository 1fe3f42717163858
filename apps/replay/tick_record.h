// SPDX-License-Identifier: Apache-2.0
// What one haptic tick and one used frame leave behind: plain values that every writer of `replay --out`
// reads.
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

enum class TickState : uint8_t { Off, Free, Contact, Escape, Trapped, Fading };
constexpr uint32_t kTickStates = 6;

// The word that haptics.csv and the frames use.
constexpr const char* stateName(TickState state) {
    constexpr const char* kNames[kTickStates] = {"off", "free", "contact", "escape", "trapped", "fading"};
    return kNames[static_cast<uint8_t>(state)];
}

// A value that was not measured or does not exist: "nan" in CSV, null in JSON, a gap in a plot.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// One row of haptics.csv, in order of its columns. Poses are base_T_tool [m]; the wrench is after all limits
// and before projection on the device's axes, base axes, torque about the proxy's centre.
struct TickRecord {
    double t = 0.0; // [s] since the run's start
    Pose device;
    Pose tool; // the proxy
    Wrench wrench;
    uint32_t contacts = 0;    // rows with a positive multiplier in the last solve
    double minGap = kUnknown; // [m] over the contact set after the tick
    TickState state = TickState::Off;
    double guidance = 0.0;      // w, 0..1
    int64_t frame = -1;         // index of the set obeyed, -1 = none
    double sceneAge = kUnknown; // [s]
    bool stalled = false;       // the trust region cut this tick
    double marginPassive = kUnknown, marginUncoupled = kUnknown;

    // Not columns: they feed summary.json and are left out of the digest.
    double stepMicros = kUnknown; // [us] compute time of the tick
    bool late = false;            // ended more than one period after its start was due
    uint32_t solves = 0;          // linearisations
    bool infeasible = false;      // some solve had no feasible step
    bool notFinite = false;       // some number was none, and there was no force
    ArmRecord arm;                // all zero without an arm
    ArmPosture armStart;          // that the tick started from
    bool driven = false;          // a real arm follows
    ArmStatus armStatus;          // by it, before the tick
};

// A pass of the frame cadence and the time it took [ms]; kUnknown when the device gives no timestamps.
using PassTime = std::pair<std::string, double>;

// One row of frames.csv. The passes are those of the plan, the same ones in the same order in each row of a
// run.
struct FrameRecord {
    uint32_t index = 0; // line of associations.txt from 0
    double t = 0.0;     // [s] capture time in the run
    uint64_t valid = 0, forbiddenPoints = 0, spheres = 0, patches = 0, nodes = 0, guidanceCount = 0;
    double uploadMs = kUnknown;
    std::vector<PassTime> passes;
    double publishMs = kUnknown;
};

} // namespace fathom
