// SPDX-License-Identifier: Apache-2.0
// Colours, fonts and spacing of the window. A colour has the same meaning as in overlay.png and traces.png.
#pragma once

#include <imgui.h>

namespace fathom::operate {

namespace colour {
constexpr ImU32 kRegion = IM_COL32(237, 41, 36, 255);
constexpr ImU32 kRegionSoft = IM_COL32(255, 140, 122, 255);
constexpr ImU32 kGuidance = IM_COL32(64, 153, 255, 255);
constexpr ImU32 kTool = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kMeasured = IM_COL32(255, 120, 220, 255); // a real arm that is off its setpoint
constexpr ImU32 kForce = IM_COL32(255, 194, 51, 255);
constexpr ImU32 kTorque = IM_COL32(186, 140, 255, 255);
constexpr ImU32 kTouch = IM_COL32(255, 236, 120, 255);
constexpr ImU32 kShade = IM_COL32(8, 10, 15, 165);
constexpr ImU32 kQuiet = IM_COL32(150, 162, 180, 255);
constexpr ImU32 kText = IM_COL32(228, 234, 242, 255);
constexpr ImU32 kGood = IM_COL32(92, 214, 150, 255);
constexpr ImU32 kAdvisory = IM_COL32(110, 214, 235, 255);
constexpr ImU32 kCaution = IM_COL32(255, 190, 60, 255);
constexpr ImU32 kWarning = IM_COL32(255, 92, 84, 255);
constexpr ImU32 kPicked = IM_COL32(40, 220, 235, 255);
// Words of states and alarms, and the plate under them: a contrast of 7 to 1 or more over any image.
constexpr ImU32 kWarningWord = IM_COL32(255, 118, 110, 255);
constexpr ImU32 kGuidanceWord = IM_COL32(96, 170, 255, 255);
constexpr ImU32 kPlate = IM_COL32(6, 8, 12, 245);
} // namespace colour

// A panel at a fixed place.
constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

// The fonts of the window, owned by ImGui's atlas.
struct Fonts {
    ImFont* body = nullptr;
    ImFont* small = nullptr;
    ImFont* bold = nullptr;
    ImFont* large = nullptr; // for the values at the top
};

// Fills the font atlas of the current context; uses ImGui's own font where DejaVu is not installed.
Fonts loadFonts(double scale);
void applyTheme(double scale);

} // namespace fathom::operate
