// SPDX-License-Identifier: Apache-2.0
// Ten seconds of force and torque with their limits, figures and events; also exported as CSV.
#pragma once

#include "apps/operate/hud.h"
#include "apps/operate/trace_columns.h"

#include <deque>
#include <filesystem>

namespace fathom::operate {

// Keeps a copy of the trace while paused.
class TracesPanel {
public:
    void draw(Console& console, const HudInput& input, ImVec2 at, ImVec2 size);
    // Writes the shown trace: t_s,fx,fy,fz,tx,ty,tz,frame,state and the six values of the residual, which is
    // the part of the wrench that the device does not render. Throws Error that names the file.
    void exportCsv(const RunView& run, const std::filesystem::path& file) const;

private:
    const std::deque<TraceSample>& shown(const RunView& run) const {
        return paused_.empty() ? run.trace() : paused_;
    }
    static void drawControls(Console& console);
    void drawCurves(Console& console, const HudInput& input);

    std::deque<TraceSample> paused_; // while paused
    Peaks pausedPeaks_;
    FrameRipple pausedRipple_;
    TraceColumns columns_; // of the shown traces
};

} // namespace fathom::operate
