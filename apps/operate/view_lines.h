// SPDX-License-Identifier: Apache-2.0
// Lines over a view: dashed ones, and outlines that were traced in its picture.
#pragma once

#include "apps/operate/view_port.h"
#include "apps/replay/silhouette.h"

#include <imgui.h>
#include <vector>

namespace fathom::operate {

// dash, width, a, b: [pixels of the window].
void dashed(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 colour, float width, float dash);

// Leaves out points that lie within a quarter of a pixel of a line between two that stay: each point that is
// drawn costs a dozen triangles. First and last stay.
void thin(std::vector<ImVec2>& points);

void outline(ImDrawList& list, const ViewPort& port, const std::vector<OutlineLine>& lines, ImU32 colour,
             float width, bool isDashed);

} // namespace fathom::operate
