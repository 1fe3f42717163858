// SPDX-License-Identifier: Apache-2.0
// What holds a class of points in place: its box, and being frozen; and who the pilot is.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/snapshots.h"

namespace fathom::operate {

// Inside the row of the panel. True when the pilot has changed `now` for good: one step of history.
bool drawHolding(Console& console, FixtureClass& now, int row, const SceneSnapshot& snapshot);

// A button a pilot; nothing when the scene has none. Asks through console.pilotWanted.
void drawPilots(Console& console, const Scene& scene);

} // namespace fathom::operate
