// SPDX-License-Identifier: Apache-2.0
// Layout and colours of traces.png.
#pragma once

#include "apps/output/plot_colours.h"

namespace fathom::traces {

constexpr int kWidth = 1600, kHeight = 1000;
constexpr double kLeft = 112.0, kRight = 1552.0; // [pixels] x range of both panels
constexpr double kTitleBase = 52.0, kSubtitleBase = 80.0;
constexpr double kStripTop = 104.0, kStripBottom = 136.0;
constexpr double kForceTop = 146.0, kForceBottom = 488.0;
constexpr double kTorqueTop = 526.0, kTorqueBottom = 868.0;
constexpr double kLegendBase = 968.0;

constexpr Colour kTrace{0.10, 0.16, 0.24};
constexpr Colour kResidual{0.62, 0.24, 0.62}; // purple: what the device cannot render
constexpr Colour kContact{0.86, 0.62, 0.30};  // sand
constexpr Colour kGuidance{0.16, 0.42, 0.80}; // blue, as in the window
constexpr Colour kAlarm{0.76, 0.16, 0.13};    // red, always hatched
constexpr Colour kIdle{0.55, 0.58, 0.62};     // off, fading

} // namespace fathom::traces
