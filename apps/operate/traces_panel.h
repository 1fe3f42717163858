// SPDX-License-Identifier: Apache-2.0
// Ten seconds of force and torque with their limits, frame ticks and marks; and the same as a file.
#pragma once

#include "apps/operate/hud.h"

#include <deque>
#include <filesystem>

namespace fathom::operate {

// 1 kHz in a few hundred columns: the smallest and the largest value of each column are drawn. Holds a copy
// of the trace while paused.
class TracesPanel {
public:
    void draw(Console& console, const HudInput& input, ImVec2 at, ImVec2 size);
    // The trace as it is shown: t_s,fx,fy,fz,tx,ty,tz,frame,state. Throws Error that names the file.
    void exportCsv(const RunView& run, const std::filesystem::path& file) const;

private:
    const std::deque<TraceSample>& shown(const RunView& run) const {
        return held_.empty() ? run.trace() : held_;
    }
    static void drawControls(Console& console);
    static void drawCurves(const std::deque<TraceSample>& trace, const HapticOptions& limits);

    std::deque<TraceSample> held_;
};

} // namespace fathom::operate
