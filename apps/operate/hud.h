// SPDX-License-Identifier: Apache-2.0
// What the pilot always sees: mode, rates, ages, margins, force and torque with their limits, recorder.
#pragma once

#include "apps/operate/camera_panel.h"
#include "apps/operate/console.h"
#include "apps/operate/device_panel.h"
#include "apps/operate/layout.h"
#include "apps/operate/measured_arm.h"
#include "apps/operate/mode.h"
#include "apps/operate/run_view.h"
#include "apps/operate/theme.h"
#include "apps/operate/wrench_figures.h"
#include "engine/cycle/haptic_options.h"

#include <string>
#include <vector>

namespace fathom::operate {

// [N s/m] With `haptics.margin: 1` automatic stiffness meets the bound exactly; a slightly longer period must
// not raise an alarm.
constexpr double kMarginNoise = -0.1;

// What the gauges show; references must stay valid during the call only.
struct HudInput {
    const RunView& run;
    const Scene& scene;
    const HapticOptions& haptics;
    const std::vector<std::string>& passNames;
    const Fonts& fonts;
    std::string title;
    double unknownShare = 0.0; // share of the image without depth
    double windowHz = 0.0;
    bool driven = false;               // a device or path drives the hand; otherwise mouse and keyboard
    const ShownArm* arm = nullptr;     // null = no real arm
    bool handGone = false;             // the haptic device is disconnected
    std::vector<std::string> armHolds; // measured_arm.h
    const CameraFacts* camera = nullptr;
    CameraControlThread* controlThread = nullptr; // with `camera`
    HandDeviceFacts device = {};
};

void drawHeadLine(Console& console, const HudInput& input, ImVec2 at, ImVec2 size);
// The pilot's row of bars: force and torque with their limits.
void drawForceStrip(Console& console, const HudInput& input, const PixelRect& room);
// "us per pass: classify 56, surface 12", of times in milliseconds, and "ms per pass" if one takes 1 ms or
// more; "none yet" without times.
std::string passTimes(const std::vector<std::string>& names, const std::vector<double>& ms);
void drawGauges(Console& console, const HudInput& input); // call inside the open ImGui window

} // namespace fathom::operate
