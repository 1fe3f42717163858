// SPDX-License-Identifier: Apache-2.0
// Closing the window: forces off first, then a question when fixtures are not saved.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/fixture_editor.h"

namespace fathom::operate {

// Once per window frame. requested: the window's close button was pressed. forcesGone: the device renders no
// force any more. Sets Console::quit when the window may end.
void stepClosing(Console& console, FixtureEditor& editor, bool requested, bool forcesGone);
// The question, in the middle of a rectangle of the window.
void drawClosing(Console& console, ImVec2 corner, ImVec2 size);

} // namespace fathom::operate
