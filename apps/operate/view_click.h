// SPDX-License-Identifier: Apache-2.0
// Handles a click in the camera view: picks a colour or places a shape when the console waits for one.
#pragma once

#include "apps/operate/fixture_editor.h"
#include "apps/operate/screen.h"

namespace fathom::operate {

// at: [pixels] of the window. Ignored when the camera view is not the large one.
void clickInView(Console& console, FixtureEditor& editor, const Screen& screen, const SceneSnapshot& scene,
                 ImVec2 at);

// What a click at the mouse or the keyboard's cursor would place; empty without a surface there.
std::optional<Shape> shapeToPlace(const Console& console, const FixtureEditor& editor, const Screen& screen,
                                  const HostFixtures& set);

} // namespace fathom::operate
