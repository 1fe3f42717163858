// SPDX-License-Identifier: Apache-2.0
// The panel of a picked colour, inside the tab Fixtures.
#pragma once

#include "apps/operate/fixture_editor.h"

namespace fathom::operate {

// What the shown pick, or the shape at the mouse, would cover.
void drawPickWarnings(const Console& console);
void drawPick(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot);

} // namespace fathom::operate
