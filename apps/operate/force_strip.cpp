// SPDX-License-Identifier: Apache-2.0
// The pilot's forces: two bars with their limits.
#include "apps/operate/hud.h"
#include "engine/types/printed.h"

#include <algorithm>

namespace fathom::operate {

namespace {

// Name, bar and value in one row.
void stripBar(const HudInput& input, ImVec2 at, ImVec2 size, const WrenchFigures& f) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    ImFont* const font = input.fonts.bold;
    const bool torque = f.part == &TraceWrench::torque;
    const std::string text = printed(torque ? "%.2f %s" : "%.1f %s", f.delivered, f.unit);
    const float letter = font->FontSize, line = 0.5f * (size.y - letter);
    const float words = font->CalcTextSizeA(letter, 1e9f, 0.0f, f.name).x + 0.7f * letter;
    const float figure = font->CalcTextSizeA(letter, 1e9f, 0.0f, "00.0 N m").x + 0.7f * letter;
    const ImVec2 a{at.x + words, at.y + 0.25f * size.y}, b{at.x + size.x - figure, at.y + 0.75f * size.y};
    const auto along = [&](double value) {
        const double share = f.limit > 0.0 ? std::clamp(value / f.limit, 0.0, 1.0) : 0.0;
        return a.x + (b.x - a.x) * static_cast<float>(share);
    };
    const ImU32 ink = f.saturated() ? colour::kWarning : f.colour;
    list.AddText(font, letter, {at.x, at.y + line}, colour::kText, f.name);
    list.AddRectFilled(a, b, IM_COL32(34, 43, 57, 255), 4.0f);
    list.AddRectFilled(a, {along(f.delivered), b.y}, ink, 4.0f);
    if (f.renderedInPart()) {
        list.AddRect(a, {along(f.whole), b.y}, colour::kText, 4.0f, 0, 1.5f);
    }
    if (f.peak > 0.0) {
        list.AddLine({along(f.peak), a.y}, {along(f.peak), b.y}, colour::kText, 2.0f);
    }
    list.AddLine({b.x, a.y - 3.0f}, {b.x, b.y + 3.0f}, colour::kWarning, 3.0f);
    list.AddText(font, letter, {b.x + 0.5f * letter, at.y + line},
                 f.saturated() ? colour::kWarning : colour::kText, text.c_str());
}

} // namespace

void drawForceStrip(Console& console, const HudInput& input, const PixelRect& room) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto x = static_cast<float>(room.x), y = static_cast<float>(room.y);
    const auto width = static_cast<float>(room.width), height = static_cast<float>(room.height);
    list.AddRectFilled({x, y}, {x + width, y + height}, IM_COL32(17, 22, 30, 255));
    const float edge = input.fonts.body->FontSize;
    const float force = 0.58f * (width - 3.0f * edge), torque = 0.42f * (width - 3.0f * edge);
    const auto [first, second] = figuresOf(input.run, input.haptics);
    stripBar(input, {x + edge, y}, {force, height}, first);
    stripBar(input, {x + 2.0f * edge + force, y}, {torque, height}, second);
    markPlace(console, "force strip", {x, y}, {width, height});
    explainArea(console, {x, y}, {2.0f * edge + force, height}, kForceTip);
    explainArea(console, {x + 2.0f * edge + force, y}, {width - force - 2.0f * edge, height}, kTorqueTip);
}

} // namespace fathom::operate
