// SPDX-License-Identifier: Apache-2.0
// The pilot's forces: two bars with their limits.
#include "apps/operate/hud.h"

#include <algorithm>
#include <cstdio>

namespace fathom::operate {

namespace {

// Name, bar and value in one row. value, limit: in the unit.
void stripBar(const HudInput& input, ImVec2 at, ImVec2 size, const char* name, double value, double limit,
              const char* form, ImU32 colour) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    ImFont* const font = input.letters.bold;
    char text[32];
    std::snprintf(text, sizeof text, form, value);
    const float letter = font->FontSize, line = 0.5f * (size.y - letter);
    const float words = font->CalcTextSizeA(letter, 1e9f, 0.0f, name).x + 0.7f * letter;
    const float figure = font->CalcTextSizeA(letter, 1e9f, 0.0f, "00.0 N m").x + 0.7f * letter;
    const double share = limit > 0.0 ? std::clamp(value / limit, 0.0, 1.0) : 0.0;
    const bool full = share > 0.98;
    list.AddText(font, letter, {at.x, at.y + line}, colour::kText, name);
    const ImVec2 a{at.x + words, at.y + 0.25f * size.y}, b{at.x + size.x - figure, at.y + 0.75f * size.y};
    list.AddRectFilled(a, b, IM_COL32(34, 43, 57, 255), 4.0f);
    list.AddRectFilled(a, {a.x + (b.x - a.x) * static_cast<float>(share), b.y},
                       full ? colour::kWarning : colour, 4.0f);
    list.AddLine({b.x, a.y - 3.0f}, {b.x, b.y + 3.0f}, colour::kWarning, 3.0f);
    list.AddText(font, letter, {b.x + 0.5f * letter, at.y + line}, full ? colour::kWarning : colour::kText,
                 text);
}

} // namespace

void drawForceStrip(Console& console, const HudInput& input, const PixelRect& room) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const StepRecord& record = input.run.step().record;
    const auto x = static_cast<float>(room.x), y = static_cast<float>(room.y);
    const auto width = static_cast<float>(room.width), height = static_cast<float>(room.height);
    list.AddRectFilled({x, y}, {x + width, y + height}, IM_COL32(17, 22, 30, 255));
    const float edge = input.letters.body->FontSize;
    const float force = 0.58f * (width - 3.0f * edge), torque = 0.42f * (width - 3.0f * edge);
    stripBar(input, {x + edge, y}, {force, height}, "Force", glm::length(record.wrench.force),
             input.haptics.forceLimit, "%.1f N", colour::kForce);
    stripBar(input, {x + 2.0f * edge + force, y}, {torque, height}, "Torque",
             glm::length(record.wrench.torque), input.haptics.torqueLimit, "%.2f N m",
             IM_COL32(186, 140, 255, 255));
    markPlace(console, "force strip", {x, y}, {width, height});
}

} // namespace fathom::operate
