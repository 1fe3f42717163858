// SPDX-License-Identifier: Apache-2.0
// Explains the contact under the mouse and marks the region sphere that stops the tool.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_marks.h"

namespace fathom::operate {

// Call inside an ImGui frame. Records the newest block as the place "contact" and puts the text into
// console.messages.contact, which is empty when no current block is under the mouse.
void drawContactTooltip(Console& console, ImDrawList& list, const MarksInput& input);

} // namespace fathom::operate
