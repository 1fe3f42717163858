// SPDX-License-Identifier: Apache-2.0
// Colours and places of traces.png.
#pragma once

#include "apps/replay/image.h"

namespace fathom::traces {

constexpr int kWidth = 1600, kHeight = 1000;
constexpr double kLeft = 112.0, kRight = 1552.0; // of both panels [pixels]
constexpr double kTitleBase = 52.0, kSubtitleBase = 80.0;
constexpr double kStripTop = 104.0, kStripBottom = 136.0;
constexpr double kForceTop = 146.0, kForceBottom = 488.0;
constexpr double kTorqueTop = 526.0, kTorqueBottom = 868.0;
constexpr double kLegendBase = 968.0;

constexpr Colour kPaper{1.0, 1.0, 1.0};
constexpr Colour kInk{0.10, 0.14, 0.19};
constexpr Colour kQuietInk{0.39, 0.43, 0.48};
constexpr Colour kGrid{0.885, 0.895, 0.91};
constexpr Colour kTrace{0.10, 0.16, 0.24};
constexpr Colour kContact{0.86, 0.62, 0.30};  // sand
constexpr Colour kGuidance{0.16, 0.42, 0.80}; // blue, as in the window
constexpr Colour kAlarm{0.76, 0.16, 0.13};    // red, always with a hatch
constexpr Colour kIdle{0.55, 0.58, 0.62};     // off, fading

} // namespace fathom::traces
