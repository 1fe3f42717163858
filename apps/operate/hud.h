// SPDX-License-Identifier: Apache-2.0
// What the pilot must always see: mode, rates, ages, margins, force and torque against their limits,
// recorder.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/measured_arm.h"
#include "apps/operate/run_view.h"
#include "apps/operate/theme.h"
#include "engine/cycle/haptic_options.h"

#include <string>
#include <vector>

namespace fathom::operate {

// The word for what forces do now, its sign and its colour: never colour alone.
struct Mode {
    const char* word = "";
    const char* sign = "";
    ImU32 colour = 0;
};
Mode modeOf(const Console& console, const RunView& run);

// [N s/m] The bound is met exactly by automatic stiffness; a period measured a little longer is no news.
constexpr double kMarginNoise = -0.1;

struct HudInput {
    const RunView& run;
    const Scene& scene;
    const HapticOptions& haptics;
    const std::vector<std::string>& passNames;
    const Letters& letters;
    std::string title;
    double unknownShare = 0.0; // of the picture without depth
    double windowHz = 0.0;
    bool driven = false;               // by a device or a path; else mouse and keyboard drive
    const MeasuredArm* arm = nullptr;  // null = none that is real
    bool handGone = false;             // the haptic device is away
    std::vector<std::string> armHolds; // measured_arm.h
};

void drawHeadLine(Console& console, const HudInput& input, ImVec2 at, ImVec2 size);
void drawGauges(Console& console, const HudInput& input); // inside the window that is open

} // namespace fathom::operate
