// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/traces_panel.h"

#include "apps/operate/trace_columns.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>

namespace fathom::operate {

namespace {

constexpr ImU32 kAxes[] = {IM_COL32(255, 120, 110, 190), IM_COL32(110, 220, 130, 190),
                           IM_COL32(110, 160, 255, 190)};

struct Plot {
    ImDrawList& list;
    ImVec2 at, size;
    double from, to;  // [s]
    double low, high; // range of the values
    float x(double t) const { return at.x + size.x * static_cast<float>((t - from) / (to - from)); }
    float y(double v) const {
        return at.y + size.y * static_cast<float>(1.0 - std::clamp((v - low) / (high - low), 0.0, 1.0));
    }
};

// Draws value(sample) as strokes (trace_columns.h).
template <class Value>
void curve(const Plot& plot, const std::deque<TraceSample>& trace, ImU32 colour, float width, Value&& value) {
    const auto column = [&](const TraceSample& sample) {
        return static_cast<int>(plot.x(sample.t) - plot.at.x);
    };
    eachColumn(trace, column, value, [&](int first, int last, float low, float high) {
        const float x = plot.at.x + 0.5f;
        plot.list.AddRectFilled({x + static_cast<float>(first) - 0.5f * width, plot.y(high) - 0.5f * width},
                                {x + static_cast<float>(last) + 0.5f * width, plot.y(low) + 0.5f * width},
                                colour);
    });
}

// Draws background, grid and limits; returns the x at which the title ends.
float frame(const Plot& plot, const char* name, double limit, const char* unit) {
    plot.list.AddRectFilled(plot.at, {plot.at.x + plot.size.x, plot.at.y + plot.size.y},
                            IM_COL32(12, 16, 23, 255), 4.0f);
    for (double s = std::ceil(plot.from); s <= plot.to; s += 1.0) {
        plot.list.AddLine({plot.x(s), plot.at.y}, {plot.x(s), plot.at.y + plot.size.y},
                          IM_COL32(40, 50, 66, 255));
    }
    plot.list.AddLine({plot.at.x, plot.y(0.0)}, {plot.at.x + plot.size.x, plot.y(0.0)},
                      IM_COL32(70, 84, 106, 255));
    for (double sign : {1.0, -1.0}) {
        if (sign * limit > plot.low && sign * limit < plot.high) {
            plot.list.AddLine({plot.at.x, plot.y(sign * limit)},
                              {plot.at.x + plot.size.x, plot.y(sign * limit)}, colour::kWarning, 1.5f);
        }
    }
    char text[96];
    std::snprintf(text, sizeof text, "%s [%s]   limit %.3g   scale %.3g", name, unit, limit, plot.high);
    plot.list.AddText({plot.at.x + 6.0f, plot.at.y + 3.0f}, colour::kQuiet, text);
    return plot.at.x + 6.0f + ImGui::CalcTextSize(text).x;
}

const char* wordOf(StepState state) {
    switch (state) {
    case StepState::Escape:
        return "escape";
    case StepState::Trapped:
        return "trapped";
    case StepState::Fading:
        return "fading";
    default:
        return "";
    }
}

// A tick where the active set changes, and a mark where the state changes, with its name where there is room.
// title: x at which the title ends [pixels].
void events(const Plot& plot, const std::deque<TraceSample>& trace, float title) {
    constexpr float kRoom = 24.0f; // [pixels] between marks, more with a name
    float free = -1e9f;
    for (size_t i = 1; i < trace.size(); ++i) {
        const float x = plot.x(trace[i].t), bottom = plot.at.y + plot.size.y;
        if (trace[i].frame != trace[i - 1].frame) {
            plot.list.AddLine({x, bottom - 4.0f}, {x, bottom}, IM_COL32(120, 134, 156, 200));
        }
        if (trace[i].guided != trace[i - 1].guided) {
            plot.list.AddTriangleFilled({x - 4.0f, plot.at.y}, {x + 4.0f, plot.at.y}, {x, plot.at.y + 7.0f},
                                        colour::kGuidance);
        } else if (trace[i].state != trace[i - 1].state && trace[i].state >= StepState::Escape && x > free) {
            free = x + kRoom;
            const char* word = wordOf(trace[i].state);
            const float end = x + 6.0f + ImGui::CalcTextSize(word).x;
            if (x > title && end < plot.at.x + plot.size.x) {
                plot.list.AddText({x + 6.0f, plot.at.y - 1.0f}, colour::kCaution, word);
                free = end + 6.0f;
            }
            plot.list.AddTriangleFilled({x - 4.0f, plot.at.y}, {x + 4.0f, plot.at.y}, {x, plot.at.y + 7.0f},
                                        colour::kCaution);
        }
        if (trace[i].late) {
            plot.list.AddLine({x, bottom - 8.0f}, {x, bottom}, colour::kWarning);
        }
    }
}

template <class Vector>
double largest(const std::deque<TraceSample>& trace, Vector&& vector) {
    double most = 0.0;
    for (const TraceSample& s : trace) {
        most = std::max(most, double{glm::length(vector(s))});
    }
    return most;
}

template <class Vector>
void drawOne(const Plot& plot, const std::deque<TraceSample>& trace, const char* name, double limit,
             const char* unit, ImU32 colour, Vector&& vector) {
    const float title = frame(plot, name, limit, unit);
    for (int axis = 0; axis < 3; ++axis) {
        curve(plot, trace, kAxes[axis], 1.0f, [&](const TraceSample& s) { return vector(s)[axis]; });
    }
    curve(plot, trace, colour, 2.0f, [&](const TraceSample& s) { return glm::length(vector(s)); });
    events(plot, trace, title);
}

// Grows in steps, so that the scale does not change all the time; includes the limit when the trace is near
// it.
double scaleFor(double most, double limit) {
    double scale = limit / 64.0;
    while (scale < 1.08 * most) {
        scale *= 2.0;
    }
    return scale >= limit ? 1.12 * std::max(limit, most) : scale;
}

} // namespace

void TracesPanel::draw(Console& console, const HudInput& input, ImVec2 at, ImVec2 size) {
    if (console.paused && held_.empty()) {
        held_ = input.run.trace();
    } else if (!console.paused) {
        held_.clear();
    }
    const std::deque<TraceSample>& trace = shown(input.run);
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("traces", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNavInputs);
    ImGui::PushFont(input.letters.small);
    drawControls(console);
    drawCurves(trace, input.haptics);
    markPlace(console, "traces");
    ImGui::PopFont();
    ImGui::End();
}

void TracesPanel::drawControls(Console& console) {
    if (markedButton(console, console.paused ? "Resume (P)" : "Pause (P)", "pause")) {
        console.paused = !console.paused;
    }
    ImGui::SameLine();
    console.exportCsv = markedButton(console, "CSV (E)", "csv") || console.exportCsv;
    for (int axis = 0; axis < 3; ++axis) {
        ImGui::SameLine();
        ImGui::TextColored(ImColor(kAxes[axis]), "%c", "xyz"[axis]);
    }
    ImGui::SameLine();
    const std::string span = console.paused ? "10 s, PAUSED" : "10 s";
    const std::string full =
        "base axes, bold: norm; torque about the tool centre; ticks below: new fixture set; " + span;
    const bool fits = ImGui::CalcTextSize(full.c_str()).x < ImGui::GetContentRegionAvail().x;
    ImGui::TextDisabled("%s", (fits ? full : span).c_str());
}

void TracesPanel::drawCurves(const std::deque<TraceSample>& trace, const HapticOptions& limits) {
    const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const double now = trace.empty() ? RunView::kSpan : trace.back().t;
    const ImVec2 half{room.x, (room.y - 4.0f) / 2.0f};
    const auto force = [](const TraceSample& s) { return s.force; };
    const auto torque = [](const TraceSample& s) { return s.torque; };
    const double forceScale = scaleFor(largest(trace, force), limits.forceLimit);
    const double torqueScale = scaleFor(largest(trace, torque), limits.torqueLimit);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    drawOne({list, corner, half, now - RunView::kSpan, now, -forceScale, forceScale}, trace, "force",
            limits.forceLimit, "N", colour::kForce, force);
    drawOne({list,
             {corner.x, corner.y + half.y + 4.0f},
             half,
             now - RunView::kSpan,
             now,
             -torqueScale,
             torqueScale},
            trace, "torque", limits.torqueLimit, "N m", IM_COL32(186, 140, 255, 255), torque);
    ImGui::Dummy(room);
}

void TracesPanel::exportCsv(const RunView& run, const std::filesystem::path& file) const {
    std::ofstream out(file);
    out << std::setprecision(9) << "t_s,fx,fy,fz,tx,ty,tz,frame,state\n";
    for (const TraceSample& s : shown(run)) {
        out << s.t;
        for (const glm::vec3& v : {s.force, s.torque}) {
            out << "," << v.x << "," << v.y << "," << v.z;
        }
        out << "," << s.frame << "," << static_cast<int>(s.state) << "\n";
    }
    out.flush();
    if (!out) {
        throw Error(file.string() + ": cannot be written");
    }
}

} // namespace fathom::operate
