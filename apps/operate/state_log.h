// SPDX-License-Identifier: Apache-2.0
// `--state FILE`: one JSON object a line, at most thirty a second: what the window shows and where, for who
// watches it from outside.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/measured_arm.h"
#include "apps/operate/run_view.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fathom::operate {

struct StateExtras {
    std::string mode;
    uint64_t begun = 0, windowFrames = 0, yielded = 0; // frames: begun, drawn, left to passes
    uint32_t swapchains = 0, width = 0, height = 0, validationMessages = 0;
    bool deviceThere = true;
    uint32_t renewals = 0; // times that the device was made anew
    double unknownShare = 0.0;
    std::vector<std::string> alarms;  // of those that are shown: level, word
    const Scene* scene = nullptr;     // in force
    size_t shapes = 0, selected = 0;  // selected: points of the preview
    const MeasuredArm* arm = nullptr; // null = none that is real
    std::string hand;                 // the live device; empty = none
    bool handThere = true;
    double stiffness = 0.0, forceLimit = 0.0; // [N/m], [N] of the pilot in force
    std::string why;                          // of the newest block
    std::vector<std::string> armHolds;        // measured_arm.h
};

class StateLog {
public:
    // An empty name writes nothing. Throws Error that names the file.
    explicit StateLog(const std::filesystem::path& file);
    // Writes when it is time, or when `now`.
    void write(const Console& console, const RunView& run, const StateExtras& extras, bool now = false);

private:
    std::ofstream out_;
    std::string name_;
    double next_ = 0.0; // [s]
};

} // namespace fathom::operate
