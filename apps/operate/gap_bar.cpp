// SPDX-License-Identifier: Apache-2.0
// The gap bar at the edge of the large view.
#include "apps/operate/depth_cues.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kBarFull = 0.2; // [m]
constexpr ImU32 kBarPlate = IM_COL32(6, 8, 12, 215), kTrack = IM_COL32(34, 43, 57, 255);

// Slanted lines: the gap is not known.
void hatchUnknown(ImDrawList& list, ImVec2 a, ImVec2 b) {
    list.PushClipRect(a, b, true);
    for (float y = a.y - (b.x - a.x); y < b.y; y += 7.0f) {
        list.AddLine({a.x, y + (b.x - a.x)}, {b.x, y}, colour::kQuiet, 1.4f);
    }
    list.PopClipRect();
}

void barTicks(ImDrawList& list, const Fonts& fonts, ImVec2 a, ImVec2 b) {
    const bool dense = b.y - a.y < 6.0f * fonts.small->FontSize;
    for (int mm = 0; mm <= 200; mm += dense ? 100 : 50) {
        const float y = b.y - (b.y - a.y) * static_cast<float>(mm) / 200.0f;
        const std::string text = std::to_string(mm);
        const ImVec2 size = fonts.small->CalcTextSizeA(fonts.small->FontSize, 1e9f, 0.0f, text.c_str());
        list.AddLine({a.x - 4.0f, y}, {a.x, y}, colour::kQuiet, 1.2f);
        list.AddText(fonts.small, fonts.small->FontSize, {a.x - 7.0f - size.x, y - 0.5f * size.y},
                     colour::kQuiet, text.c_str());
    }
}

// The ranges of the colours, as a narrow strip at the right of the bar.
void barZones(ImDrawList& list, ImVec2 a, ImVec2 b, float width) {
    const auto level = [&](double gap) { return b.y - (b.y - a.y) * static_cast<float>(gap / kBarFull); };
    const float left = b.x + 2.0f;
    list.AddRectFilled({left, level(kNearGap)}, {left + width, level(kCloseGap)}, gapColour(GapLook::Near));
    list.AddRectFilled({left, level(kCloseGap)}, {left + width, b.y}, gapColour(GapLook::Close));
}

} // namespace

void drawGapBar(Console& console, const DepthCues& cues, const Fonts& fonts, const PixelRect& place) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    console.places.erase("gap bar");
    const float line = fonts.body->FontSize, width = 1.1f * line;
    const float room = 5.6f * line; // for the widest value
    const float height = std::min(static_cast<float>(place.height) - 2.2f * line, 18.0f * line);
    if (height < 5.0f * line) {
        return; // no room for its figures
    }
    const ImVec2 plate{static_cast<float>(place.x) + 0.5f * (static_cast<float>(place.width) - room),
                       static_cast<float>(place.y) +
                           0.5f * (static_cast<float>(place.height) - height - 2.2f * line)};
    list.AddRectFilled(plate, {plate.x + room, plate.y + height + 2.2f * line}, kBarPlate, 6.0f);
    const ImVec2 a{plate.x + 0.5f * (room - width) + 0.4f * line, plate.y + 0.9f * line};
    const ImVec2 b{a.x + width, a.y + height - 1.0f * line};
    list.AddRectFilled(a, b, kTrack, 3.0f);
    barTicks(list, fonts, a, b);
    barZones(list, a, b, 0.3f * line);
    const bool finite = std::isfinite(cues.gap);
    const ImU32 colour = finite ? gapColour(lookOf(cues.gap)) : colour::kQuiet;
    if (finite) {
        const auto share = static_cast<float>(std::clamp(cues.gap / kBarFull, 0.0, 1.0));
        const float y = b.y - share * (b.y - a.y);
        list.AddRectFilled({a.x, y}, b, colour, 3.0f);
        list.AddRectFilled({a.x - 4.0f, y - 2.0f}, {b.x + 4.0f, y + 2.0f}, colour);
    } else if (std::isnan(cues.gap)) {
        hatchUnknown(list, a, b);
    }
    const std::string text = gapText(cues.gap);
    ImFont* const font = fonts.bold;
    const ImVec2 words = font->CalcTextSizeA(font->FontSize, 1e9f, 0.0f, text.c_str());
    list.AddText(font, font->FontSize, {plate.x + 0.5f * (room - words.x), b.y + 0.55f * line}, colour,
                 text.c_str());
    markPlace(console, "gap bar", plate, {room, height + 2.2f * line});
    explainArea(console, plate, {room, height + 2.2f * line},
                "Distance from the tool to the nearest region of points [mm]: amber below 50, red below 10; "
                "hatched while it is unknown");
}

} // namespace fathom::operate
