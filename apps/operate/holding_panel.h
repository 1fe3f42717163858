// SPDX-License-Identifier: Apache-2.0
// Controls for the box and the frozen state of a class of points, and for the pilot.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/snapshots.h"

namespace fathom::operate {

// Draws inside the row of the fixture. True when `now` has changed: one undo step.
bool drawHolding(Console& console, FixtureClass& now, int row, const SceneSnapshot& snapshot);

// One button per pilot of the scene; sets console.requests.pilot.
void drawPilots(Console& console, const Scene& scene);

} // namespace fathom::operate
