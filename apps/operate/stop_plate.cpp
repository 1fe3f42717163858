// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/stop_plate.h"

#include <algorithm>

namespace fathom::operate {

namespace {

constexpr const char* kBetween = "   ";

// The keys that are useful in the present state.
std::string hintOf(const Console& console, bool driven) {
    if (console.timeLine.on) {
        return "Recording.   Drag the time line   Space: play   arrows: frames, with Shift ticks   "
               "[ ]: speed   Tab: 3D   F1: all keys";
    }
    if (console.aims()) {
        return "Click, or use arrows (Shift: slowly) and Enter   Esc: cancel";
    }
    if (console.panels.haveKeys) {
        return "Keyboard in the panels: arrows choose, Enter presses   Space: forces off   F6, Esc: back";
    }
    const std::string moves = driven ? "" : "drag, wheel, arrows: tool   ";
    if (console.settings.spaceIsLarge) {
        return "Right drag: turn the view   1 2 3: front, side, top   0: reset   "
               "Ctrl+wheel: distance   Tab: camera   F1: all keys";
    }
    const std::string hint = console.switches.forces
                                 ? "Space: forces off   G: guidance   " + moves + "F1: all keys"
                                 : "A: arm the forces   " + moves + "Tab: 3D   F1: all keys";
    return driven ? hint : "No haptic device: mouse and keyboard move the tool.   " + hint;
}

} // namespace

std::string piecesThatFit(const std::string& hint, float width) {
    std::vector<std::string> pieces;
    for (size_t from = 0, to = 0; from < hint.size(); from = to + 3) {
        to = std::min(hint.find(kBetween, from), hint.size());
        pieces.push_back(hint.substr(from, to - from));
    }
    const auto joined = [&] {
        std::string all;
        for (const std::string& piece : pieces) {
            all += (all.empty() ? "" : kBetween) + piece;
        }
        return all;
    };
    while (pieces.size() > 1 && ImGui::CalcTextSize(joined().c_str()).x > width) {
        pieces.erase(pieces.end() - 2);
    }
    return joined();
}

float drawWordsAbove(float x, float bottom, float width, const std::string& words, ImU32 colour) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, width);
    const float top = bottom - size.y - 4.0f;
    list.AddRectFilled({x - 4.0f, top - 2.0f}, {x + size.x + 4.0f, top + size.y + 2.0f}, colour::kPlate,
                       3.0f);
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {x, top}, colour, words.c_str(), nullptr, width);
    return size.y + 8.0f;
}

void besideView(Rooms& rooms, const PixelRect& view, float scale) {
    const auto pixels = [scale](float at) { return static_cast<int>(at * scale); };
    const int wide = pixels(124.0f), high = pixels(44.0f), bar = pixels(80.0f), inside = pixels(16.0f);
    const int right = view.x + view.width, bottom = view.y + view.height;
    const int free = rooms.large.x + rooms.large.width - right;
    if (free >= wide + pixels(8.0f)) {
        rooms.stop = {right + (free - wide) / 2, bottom - high - pixels(4.0f), wide, high};
        rooms.gap = {right, view.y, free, view.height - high - inside};
        return;
    }
    rooms.stop = {right - wide - inside, bottom - high - inside, wide, high};
    const int top = pixels(40.0f);
    rooms.gap = {right - bar - inside, view.y + top, bar, view.height - top - high - inside - pixels(8.0f)};
}

void drawStop(Console& console, const Fonts& fonts, const PixelRect& room) {
    ImGui::SetNextWindowPos(cornerOf(room));
    ImGui::SetNextWindowSize(sizeOf(room));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleColor(ImGuiCol_WindowBg,
                          console.switches.forces ? IM_COL32(150, 22, 16, 255) : IM_COL32(44, 16, 18, 255));
    ImGui::Begin("stop", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
    if (ImGui::InvisibleButton("forces off", sizeOf(room))) {
        console.switches.forcesOff();
    }
    explain(console, "Space, or a click: forces off, whatever has the focus");
    markPlace(console, "stop");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 a = cornerOf(room), size = sizeOf(room);
    list.AddRect({a.x + 1.0f, a.y + 1.0f}, {a.x + size.x - 1.0f, a.y + size.y - 1.0f}, colour::kWarning, 6.0f,
                 0, 2.0f);
    const auto middle = [&](ImFont* font, float y, const char* words) {
        const ImVec2 text = font->CalcTextSizeA(font->FontSize, 1e9f, 0.0f, words);
        list.AddText(font, font->FontSize, {a.x + 0.5f * (size.x - text.x), y}, IM_COL32(255, 255, 255, 255),
                     words);
        return text.y;
    };
    const float lines = fonts.bold->FontSize + fonts.small->FontSize + 2.0f;
    const float top = a.y + 0.5f * (size.y - lines);
    const float next = middle(fonts.bold, top, "\xe2\x96\xa0 SPACE");
    middle(fonts.small, top + next + 2.0f, console.switches.forces ? "forces off" : "forces are off");
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

void drawHint(Console& console, bool driven, const PixelRect& view, const PixelRect& stop) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    if (console.cursor) {
        const ImVec2 c = *console.cursor;
        list.AddCircle(c, 9.0f, colour::kPicked, 0, 2.0f);
        list.AddLine({c.x - 14.0f, c.y}, {c.x + 14.0f, c.y}, colour::kPicked);
        list.AddLine({c.x, c.y - 14.0f}, {c.x, c.y + 14.0f}, colour::kPicked);
    }
    const float inside = 18.0f * console.scale(); // of the frame
    const float x = static_cast<float>(view.x) + inside;
    const float end =
        static_cast<float>(std::min(view.x + view.width, stop.width > 0 ? stop.x : view.x + view.width));
    const float width = std::max(80.0f, end - x - inside);
    float bottom = static_cast<float>(view.y + view.height) - 0.6f * inside;
    bottom -= drawWordsAbove(x, bottom, width, piecesThatFit(hintOf(console, driven), width), colour::kText);
    if (ImGui::GetTime() < console.messages.noticeUntil) {
        drawWordsAbove(x, bottom, width, console.messages.notice, colour::kPicked);
    }
}

} // namespace fathom::operate
