// SPDX-License-Identifier: Apache-2.0
// Pointing at a contact explains it, and shows what it is that stops the tool.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_marks.h"

namespace fathom::operate {

// Inside an ImGui frame. Marks the newest block as the place "contact" and leaves the words that are shown in
// console.hovered; empty when the mouse is at no block that lasts.
void drawHover(Console& console, ImDrawList& list, const MarksInput& input);

} // namespace fathom::operate
