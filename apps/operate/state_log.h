// SPDX-License-Identifier: Apache-2.0
// Writes `--state FILE`: one JSON object per line, at most 30 per second, with what the window shows and
// where, for tests and other programs.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/measured_arm.h"
#include "apps/operate/run_view.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fathom::operate {

// State that StateLog::write() cannot read from console and run view.
struct StateExtras {
    std::string mode;
    uint64_t begun = 0, windowFrames = 0, yielded = 0; // window frames: begun, drawn, skipped for passes
    uint32_t swapchains = 0, width = 0, height = 0, validationMessages = 0;
    bool deviceThere = true;
    uint32_t renewals = 0; // times that the device was recreated
    double unknownShare = 0.0;
    std::vector<std::string> alarms;  // shown alarms: level, key
    const Scene* scene = nullptr;     // the active scene
    size_t shapes = 0, selected = 0;  // selected: number of points in the preview
    const MeasuredArm* arm = nullptr; // null = no real arm
    std::string hand;                 // the live device; empty = none
    bool handThere = true;
    double stiffness = 0.0, forceLimit = 0.0; // [N/m], [N] of the active pilot
    std::string why;                          // of the newest block
    std::vector<std::string> armHolds;        // measured_arm.h
};

class StateLog {
public:
    // An empty file name disables the log. Throws Error that names the file.
    explicit StateLog(const std::filesystem::path& file);
    // Writes when the next line is due, or at once if `now`.
    void write(const Console& console, const RunView& run, const StateExtras& extras, bool now = false);

private:
    std::ofstream out_;
    std::string name_;
    double next_ = 0.0; // [s]
};

} // namespace fathom::operate
