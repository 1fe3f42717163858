// SPDX-License-Identifier: Apache-2.0
// Explains the contact under the mouse and marks the region sphere that stops the tool.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_marks.h"

namespace fathom::operate {

// Inside an ImGui frame. Records the newest block as the place "contact" and stores the text in
// console.hovered; the text is empty when no present block is under the mouse.
void drawContactTooltip(Console& console, ImDrawList& list, const MarksInput& input);

} // namespace fathom::operate
