// SPDX-License-Identifier: Apache-2.0
// The panel with the tabs: fixtures, why, alarms, keys.
#pragma once

#include "apps/operate/alarms.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/hud.h"

namespace fathom::operate {

// Valid during the call only.
struct TabsInput {
    const RunView& run;
    const HudInput& hud;
};

void drawTabs(Console& console, FixtureEditor& editor, Alarms& alarms, const TabsInput& input,
              const PixelRect& room);

} // namespace fathom::operate
