// SPDX-License-Identifier: Apache-2.0
// A click on the camera's picture: picks a colour or places a shape, where the console waits for one.
#pragma once

#include "apps/operate/fixture_editor.h"
#include "apps/operate/screen.h"

namespace fathom::operate {

// at: [pixels] of the window. Nothing happens when the camera's view is not the large one.
void clickInView(Console& console, FixtureEditor& editor, const Screen& screen, const SceneSnapshot& scene,
                 ImVec2 at);

} // namespace fathom::operate
