// SPDX-License-Identifier: Apache-2.0
// The ticks of a recording as text: wrench.csv with one row per tick, and touches.csv with one row per
// contact that pushed in a tick. Written by the recorder, read by playback.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/run/channels.h"

#include <filesystem>
#include <iosfwd>
#include <vector>

namespace fathom::operate {

// One recorded tick. Values missing in older recordings are NaN.
struct RecordedTick {
    double t = 0.0;                                      // [s] in the recording
    Wrench wrench;                                       // on the hand, base axes
    Wrench residual{dvec3(kNotKnown), dvec3(kNotKnown)}; // the part that the device could not render
    uint32_t contacts = 0;
    StepState state = StepState::Off;
    double guidance = 0.0;  // weight
    int guidanceClass = -1; // as in StepRecord
    double sceneAge = kNotKnown, marginPassive = kNotKnown, marginUncoupled = kNotKnown;
    int64_t frame = -1; // frame of the recording whose set was used
    Pose device, tool;  // base_T_tool
    ArmPosture arm;     // all zero without an arm
    size_t firstTouch = 0;
    uint32_t touchCount = 0; // range in TickLog::touches
};

// All ticks of a recording.
struct TickLog {
    std::vector<RecordedTick> ticks; // in ascending time
    std::vector<Touch> touches;
    bool poses = false; // device and tool poses are recorded
    bool cut = false;   // the recording has more ticks

    // The step record, as far as the files contain it.
    StepRecord recordAt(size_t i) const;
    // The record as a live run gives it to displays. hand: the recorded one, for its buttons; null = none are
    // known. Whether the device was there, and which regions disappeared, is not recorded.
    TickRow rowAt(size_t i, const HandPath* hand) const;
};

inline constexpr const char* kWrenchFile = "wrench.csv";
inline constexpr const char* kTouchesFile = "touches.csv";
const char* wrenchHeader(); // header of the file
const char* touchesHeader();

// Writes one tick at `t` [s] of the recording. frame: the frame of the recording whose set was used. Columns
// target and frame count from 1; 0 is none.
void writeTick(std::ostream& wrench, std::ostream& touches, double t, int64_t frame, const StepRecord& tick);

inline constexpr size_t kMaxLoggedTicks = 4'000'000; // 67 minutes at 1 kHz

// Reads both files of a folder; empty without wrench.csv. Throws BadInput with file, line and column. Accepts
// older versions of wrench.csv with fewer columns. most: ticks, from the first; later ones are not read.
TickLog readTickLog(const std::filesystem::path& folder, size_t most = kMaxLoggedTicks);

} // namespace fathom::operate
