// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/traces_panel.h"

#include "apps/operate/trace_plot.h"
#include "engine/types/error.h"

#include <algorithm>
#include <fstream>
#include <iomanip>

namespace fathom::operate {

void TracesPanel::draw(Console& console, const HudInput& input, ImVec2 at, ImVec2 size) {
    if (console.panels.tracesPaused && paused_.empty()) {
        paused_ = input.run.trace();
        pausedPeaks_ = input.run.peaks();
        pausedRipple_ = input.run.ripple();
    } else if (!console.panels.tracesPaused) {
        paused_.clear();
    }
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("traces", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNavInputs);
    ImGui::PushFont(input.fonts.small);
    drawControls(console);
    drawCurves(console, input);
    ImGui::PopFont();
    ImGui::End();
}

void TracesPanel::drawControls(Console& console) {
    if (markedButton(console, console.panels.tracesPaused ? "Resume (P)" : "Pause (P)", "pause",
                     "P: hold the traces; forces continue")) {
        console.panels.tracesPaused = !console.panels.tracesPaused;
    }
    ImGui::SameLine();
    console.requests.exportTraces =
        markedButton(console, "CSV (E)", "csv", "E: write the shown ten seconds to traces.csv") ||
        console.requests.exportTraces;
    for (int axis = 0; axis < 3; ++axis) {
        ImGui::SameLine();
        ImGui::TextColored(ImColor(kAxisColours[axis]), "%c", "xyz"[axis]);
    }
    ImGui::SameLine();
    const std::string span = console.panels.tracesPaused ? "10 s, PAUSED" : "10 s";
    const std::string full = "delivered, base axes; bold: size; dashed: residual, not rendered; " + span;
    const bool fits = ImGui::CalcTextSize(full.c_str()).x < ImGui::GetContentRegionAvail().x;
    ImGui::TextDisabled("%s", (fits ? full : span).c_str());
}

void TracesPanel::drawCurves(Console& console, const HudInput& input) {
    constexpr float kApart = 4.0f; // [pixels]
    const std::deque<TraceSample>& trace = shown(input.run);
    const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const double now = trace.empty() ? RunView::kSpan : trace.back().t;
    const float lane = ImGui::GetTextLineHeight(), left = corner.x + scaleColumn(),
                width = std::max(40.0f, corner.x + room.x - figuresColumn() - left);
    const float half = std::max(16.0f, 0.5f * (room.y - lane) - kApart);
    TraceArea area{{left, corner.y}, {width, half}, now - RunView::kSpan, now};
    columns_.follow(trace, input.run.restarts(), static_cast<int>(width));
    for (const WrenchFigures& plot : paused_.empty()
                                         ? figuresOf(input.run, input.haptics)
                                         : figuresOf(paused_, pausedPeaks_, pausedRipple_, input.haptics)) {
        drawTracePlot(plot, area, columns_);
        markPlace(console, std::string("trace ") + plot.name, area.at, area.size);
        ImGui::SetCursorScreenPos(area.at);
        ImGui::Dummy(area.size);
        explain(console, plot.part == &TraceWrench::force ? kForceTip : kTorqueTip);
        area.at.y += half + kApart;
    }
    area.size.y = lane;
    drawEvents(area, trace);
    ImGui::GetWindowDrawList()->AddText({left + width + ImGui::GetFontSize(), area.at.y}, colour::kQuiet,
                                        "events");
    ImGui::SetCursorScreenPos(area.at);
    ImGui::Dummy(area.size);
    markPlace(console, "events");
    markPlace(console, "traces", corner, room);
    explain(console,
            "Events of these ten seconds. Short marks: a new fixture set. Red lines: late ticks. Bars: "
            "guidance, and states with their names.");
}

void TracesPanel::exportCsv(const RunView& run, const std::filesystem::path& file) const {
    std::ofstream out(file);
    out << std::setprecision(9) << "t_s,fx,fy,fz,tx,ty,tz,frame,state,"
        << "residual_fx,residual_fy,residual_fz,residual_tx,residual_ty,residual_tz\n";
    const auto put = [&](const TraceWrench& w) {
        for (const glm::vec3& v : {w.force, w.torque}) {
            out << "," << v.x << "," << v.y << "," << v.z;
        }
    };
    for (const TraceSample& s : shown(run)) {
        out << s.t;
        put(s.whole);
        out << "," << s.frame << "," << static_cast<int>(s.state);
        put(s.residual);
        out << "\n";
    }
    out.flush();
    if (!out) {
        throw Error(file.string() + ": cannot be written");
    }
}

} // namespace fathom::operate
