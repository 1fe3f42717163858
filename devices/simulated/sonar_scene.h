// SPDX-License-Identifier: Apache-2.0
// The scene of the simulated sonar: a steel pipe with a valve wheel over sand, a concrete block next to it.
#pragma once

#include "devices/simulated/analytic_scene.h"

namespace fathom {

// Objects: 0 surroundings, 1 "steel" (pipe along x at z = 1.5, wheel about (-0.15, -0.05, 1.36)), 2 "block"
// (about (0.55, 0.32, 1.6)). The red channel of a paint's albedo is the reflectivity for sound.
AnalyticScene sonarScene();

} // namespace fathom
