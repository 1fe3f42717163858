// SPDX-License-Identifier: Apache-2.0
// The built-in underwater scene: a valve panel in a tank.
#pragma once

#include "devices/simulated/analytic_scene.h"

namespace fathom {

// Objects: 0 surroundings, 1 "red valve" (wheel about (-0.15, 0, 0.86)), 2 "yellow valve" (wheel about (0.15,
// 0, 0.86)); rims of 70 mm, 0.30 m apart, so that their regions of 4 cm stay apart. Panel front at z = 1.0.
AnalyticScene tankScene();

} // namespace fathom
