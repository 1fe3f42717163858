// SPDX-License-Identifier: Apache-2.0
// The turns of a recording as text: wrench.csv, a row a turn, and touches.csv, a row each condition that
// pushed in one. Written by the recorder, read by who looks back.
#pragma once

#include "apps/binding/crossings.h"

#include <filesystem>
#include <iosfwd>
#include <vector>

namespace fathom::operate {

// One turn that was recorded. What an older recording does not tell is NaN.
struct Moment {
    double t = 0.0; // [s] of the recording
    Wrench wrench;  // on the hand, base axes
    uint32_t contacts = 0;
    StepState state = StepState::Off;
    double guidance = 0.0;  // w
    int guidanceClass = -1; // StepRecord's
    double sceneAge = kNotKnown, marginPassive = kNotKnown, marginUncoupled = kNotKnown;
    int64_t frame = -1; // picture of the recording whose set it obeyed
    Pose device, tool;  // base_T_tool
    ArmPosture arm;     // all zero without one
    size_t firstTouch = 0;
    uint32_t touchCount = 0; // in TickLog::touches
};

struct TickLog {
    std::vector<Moment> moments; // times ascend
    std::vector<Touch> touches;
    bool poses = false; // device and tool are known

    // As the run's writer had it, without what no file tells.
    StepRecord recordAt(size_t i) const;
};

inline constexpr const char* kWrenchFile = "wrench.csv";
inline constexpr const char* kTouchesFile = "touches.csv";
const char* wrenchHead(); // first line of either file
const char* touchesHead();

// Columns target and frame count from 1, 0 is none.
// One turn at `t` [s] of the recording; `frame`: the picture that it obeyed, counted as in the recording.
void writeTurn(std::ostream& wrench, std::ostream& touches, double t, int64_t frame, const StepRecord& tick);

// Both files of a folder; empty when it has no wrench.csv. Throws BadInput with file, line and column.
// Takes wrench.csv of before there were poses in it, too. At most four million turns.
TickLog readTickLog(const std::filesystem::path& folder);

} // namespace fathom::operate
