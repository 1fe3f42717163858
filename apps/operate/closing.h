// SPDX-License-Identifier: Apache-2.0
// Closing the window: forces off first, then a question when fixtures are not saved.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/fixture_editor.h"

namespace fathom::operate {

// What closing depends on.
struct CloseInput {
    bool requested = false;  // the window's close button was pressed
    bool forcesGone = false; // the device renders no force any more
    double now = 0.0;        // [s] of the session
};
// The longest time that closing waits for the forces to go [s].
constexpr double kLongestFade = 5.0;

// Once per window frame. Sets Closing::quit when the window may end. Forces that are still there after
// kLongestFade, for example because no tick comes any more, are named in a line; the end of the run switches
// them off.
void stepClosing(Console& console, FixtureEditor& editor, const CloseInput& input);
// The question, in the middle of a rectangle of the window.
void drawClosing(Console& console, ImVec2 corner, ImVec2 size);

} // namespace fathom::operate
