// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/time_line_panel.h"

#include "apps/operate/keys.h"
#include "apps/operate/past_scene.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <optional>

namespace fathom::operate {

namespace {

constexpr double kTick = 0.001; // [s] per step outside the recorded ticks
constexpr double kSlowest = 1.0 / 16.0, kFastest = 4.0;

// Starts from the beginning when the recording has ended.
void togglePlay(TimeLine& line) {
    line.playing = !line.playing;
    line.t = line.playing && line.t >= line.duration ? 0.0 : line.t;
}

void stepFrames(TimeLine& line, int by) {
    const auto now = static_cast<int64_t>(std::floor(line.t / PastScene::kPeriod + 1e-6));
    line.t = static_cast<double>(std::max<int64_t>(0, now + by)) * PastScene::kPeriod;
    line.playing = false;
}

// Moves to the next or previous recorded tick.
void stepTicks(TimeLine& line, const std::vector<double>& times, int by) {
    constexpr double kSame = 1e-9; // [s]
    line.playing = false;
    if (by > 0) {
        const auto next = std::upper_bound(times.begin(), times.end(), line.t + kSame);
        line.t = next == times.end() ? line.t + kTick : *next;
    } else {
        const auto here = std::lower_bound(times.begin(), times.end(), line.t - kSame);
        line.t = here == times.begin() ? line.t - kTick : *(here - 1);
    }
}

// Moves to the next or previous mark; stays where there is none.
void stepMarks(TimeLine& line, int by) {
    constexpr double kSame = 1e-6; // [s]
    std::optional<double> to;
    for (const EventMark& mark : line.marks) {
        if (by > 0 ? mark.t > line.t + kSame && !to : mark.t < line.t - kSame) {
            to = mark.t;
        }
    }
    line.playing = line.playing && !to;
    line.t = to.value_or(line.t);
}

// A flag per mark, with its name where there is room.
void drawMarks(ImDrawList& list, const TimeLine& line, ImVec2 at, ImVec2 room) {
    float free = at.x; // from here on for names
    for (const EventMark& mark : line.marks) {
        const double share = line.duration > 0.0 ? std::min(1.0, mark.t / line.duration) : 0.0;
        const float x = at.x + room.x * static_cast<float>(share);
        list.AddLine({x, at.y}, {x, at.y + room.y}, colour::kText, 2.0f);
        list.AddTriangleFilled({x, at.y}, {x + 8.0f, at.y + 4.0f}, {x, at.y + 8.0f}, colour::kText);
        const float wide = ImGui::CalcTextSize(mark.name.c_str()).x;
        if (x + 11.0f >= free && x + 11.0f + wide <= at.x + room.x && room.y > ImGui::GetTextLineHeight()) {
            list.AddText({x + 11.0f, at.y}, colour::kText, mark.name.c_str());
            free = x + 17.0f + wide;
        }
    }
}

} // namespace

TimeLinePanel::TimeLinePanel(const TickLog& log, double duration)
    : columns_(kColumns) {
    for (const RecordedTick& recorded : log.ticks) {
        times_.push_back(recorded.t);
        const double share = duration > 0.0 ? recorded.t / duration : 0.0;
        const auto at =
            static_cast<size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(kColumns - 1) + 0.5);
        const auto force = static_cast<float>(glm::length(recorded.wrench.force));
        Column& column = columns_[at];
        column.any = true;
        column.force = std::max(column.force, std::isfinite(force) ? force : 0.0f);
        column.contact = column.contact || recorded.contacts > 0;
        column.guided = column.guided || recorded.guidance > 0.0;
        peak_ = std::max(peak_, column.force);
    }
}

void TimeLinePanel::handleKeys(Console& console) const {
    TimeLine& line = console.timeLine;
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [](int key) { return keyPressed(key, true); };
    if (!io.WantTextInput && !io.KeyCtrl && !console.panels.haveKeys) {
        if (keyPressed(GLFW_KEY_SPACE)) {
            togglePlay(line);
        }
        for (const auto& [key, by] : {std::pair(GLFW_KEY_LEFT, -1), std::pair(GLFW_KEY_RIGHT, 1)}) {
            if (pressed(key)) {
                io.KeyShift ? stepTicks(line, times_, by) : stepFrames(line, by);
            }
        }
        if (pressed(GLFW_KEY_HOME)) {
            line.t = 0.0;
        }
        if (pressed(GLFW_KEY_END)) {
            line.t = line.duration;
        }
        for (const auto& [key, by] : {std::pair(GLFW_KEY_COMMA, -1), std::pair(GLFW_KEY_PERIOD, 1)}) {
            if (pressed(key)) {
                stepMarks(line, by);
            }
        }
        if (pressed(GLFW_KEY_LEFT_BRACKET)) {
            line.speed = std::max(kSlowest, 0.5 * line.speed);
        }
        if (pressed(GLFW_KEY_RIGHT_BRACKET)) {
            line.speed = std::min(kFastest, 2.0 * line.speed);
        }
    }
    line.t = std::clamp(line.t, 0.0, line.duration);
}

void TimeLinePanel::draw(Console& console, const Fonts& fonts, ImVec2 at, ImVec2 size) const {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("time line", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNavInputs);
    ImGui::PushFont(fonts.small);
    drawButtons(console);
    drawStrip(console);
    ImGui::PopFont();
    ImGui::End();
}

void TimeLinePanel::drawButtons(Console& console) const {
    TimeLine& line = console.timeLine;
    const auto button = [&](const char* label, const char* name, const char* tip) {
        const bool hit = markedButton(console, label, name, tip);
        ImGui::SameLine(0.0f, 5.0f);
        return hit;
    };
    if (button("|<", "to begin", "Home: to the beginning")) {
        line.t = 0.0;
    }
    if (button("< frame", "back", "Left arrow: one frame back; with Shift one tick")) {
        stepFrames(line, -1);
    }
    if (button(line.playing ? "Pause (Space)" : "\xe2\x96\xb6 Play (Space)", "play",
               "Space: play or pause. [ and ]: half or twice the speed")) {
        togglePlay(line);
    }
    if (button("frame >", "forth", "Right arrow: one frame on; with Shift one tick")) {
        stepFrames(line, 1);
    }
    if (button(">|", "to end", "End: to the end")) {
        line.t = line.duration;
    }
    ImGui::TextDisabled("  %.3f of %.3f s   frame %u of %u   speed %.3g   peak %.2f N%s", line.t,
                        line.duration, line.frame + 1, line.frames, line.speed, double{peak_},
                        line.wholeMemory ? "" : "   this frame only");
}

// The recorded force, contact in yellow, guidance in blue, one mark per frame, and the position marker.
void TimeLinePanel::drawStrip(Console& console) const {
    TimeLine& line = console.timeLine;
    const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    ImGui::InvisibleButton("strip", {std::max(16.0f, room.x), std::max(12.0f, room.y)});
    markPlace(console, "time line");
    explain(
        console,
        "Drag: another moment. The curve is the recorded force: yellow while a fixture pushes. Blue below: "
        "guidance. Flags: marks (N)");
    line.dragged = ImGui::IsItemActive();
    if (line.dragged && line.duration > 0.0) {
        const double share = (double{ImGui::GetIO().MousePos.x} - double{at.x}) / double{room.x};
        line.t = std::clamp(share, 0.0, 1.0) * line.duration;
        line.playing = false;
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float low = at.y + room.y, step = room.x / static_cast<float>(kColumns);
    list.AddRectFilled(at, {at.x + room.x, low}, IM_COL32(12, 16, 23, 255), 4.0f);
    for (size_t i = 0; i < kColumns; ++i) {
        const Column& column = columns_[i];
        const float x = at.x + step * static_cast<float>(i);
        const float tall = peak_ > 0.0f ? (room.y - 8.0f) * column.force / peak_ : 0.0f;
        list.AddRectFilled({x, low - 4.0f - tall}, {x + step + 0.5f, low - 4.0f},
                           column.contact ? colour::kTouch : colour::kForce);
        if (column.any) {
            list.AddRectFilled({x, low - 4.0f}, {x + step + 0.5f, low},
                               column.guided ? colour::kGuidance : IM_COL32(52, 66, 88, 255));
        }
    }
    const float apart = room.x / static_cast<float>(std::max(1u, line.frames));
    for (uint32_t i = 0; apart > 4.0f && i < line.frames; ++i) {
        const float x = at.x + apart * static_cast<float>(i);
        list.AddLine({x, at.y}, {x, at.y + 4.0f}, IM_COL32(120, 134, 156, 160));
    }
    drawMarks(list, line, at, room);
    const double share = line.duration > 0.0 ? line.t / line.duration : 0.0;
    const float head = at.x + room.x * static_cast<float>(share);
    list.AddLine({head, at.y}, {head, low}, colour::kPicked, 2.0f);
    list.AddTriangleFilled({head - 6.0f, at.y}, {head + 6.0f, at.y}, {head, at.y + 9.0f}, colour::kPicked);
}

} // namespace fathom::operate
