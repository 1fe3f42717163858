// SPDX-License-Identifier: Apache-2.0
// A wet-mate connector next to a valve: an arm approaches the connector and must not touch the valve.
#pragma once

#include "devices/simulated/analytic_scene.h"

namespace fathom {

// Scene frame as all. The red wheel's middle and the middle of the yellow receptacle's face, which looks at
// the camera [m].
inline constexpr dvec3 kWetmateWheel{-0.08, 0.0, 0.86};
inline constexpr dvec3 kWetmateFace{0.12, 0.03, 0.88};

// The whole scene. Any thread.
AnalyticScene wetmateScene();

} // namespace fathom
