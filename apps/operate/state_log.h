// SPDX-License-Identifier: Apache-2.0
// Writes `--state FILE`: one JSON object per line, at most 30 per second, with what the window shows and
// where, for tests and other programs.
#pragma once

#include "apps/operate/alarms.h"
#include "apps/operate/canvas.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/screen.h"
#include "apps/session/session.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace fathom::operate {

// The objects whose state is written.
struct ShownState {
    const Console& console;
    const RunView& view;
    const Session& session;
    const Window& window;
    const Canvas& canvas;
    const Screen& screen;
    const Alarms& alarms;
    const FixtureEditor& editor;
    const HapticOptions& haptics;
    const ShownArm* measured = nullptr; // null = no real arm
    const HandDeviceFacts& device;
    double frameCost = 0.0; // [s] CPU time of a window frame
    const CameraFacts* camera = nullptr;
    const CameraControlThread* controlThread = nullptr;
};

class StateLog {
public:
    // An empty file name disables the log. appends: keeps the lines that are there. Throws Error that names
    // the file; BadInput for one that this process reads.
    explicit StateLog(const std::filesystem::path& file, bool appends = false);
    // Writes when the next line is due, or at once if `now`.
    void write(const ShownState& shown, bool now);

private:
    std::ofstream out_;
    std::string name_;
    double next_ = 0.0; // [s]
};

} // namespace fathom::operate
