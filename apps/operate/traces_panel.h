// SPDX-License-Identifier: Apache-2.0
// Ten seconds of force and torque with their limits, frame ticks and marks; also exported as CSV.
#pragma once

#include "apps/operate/hud.h"

#include <deque>
#include <filesystem>

namespace fathom::operate {

// Draws the minimum and maximum of each pixel column. Keeps a copy of the trace while paused.
class TracesPanel {
public:
    void draw(Console& console, const HudInput& input, ImVec2 at, ImVec2 size);
    // Writes the shown trace: t_s,fx,fy,fz,tx,ty,tz,frame,state. Throws Error that names the file.
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
