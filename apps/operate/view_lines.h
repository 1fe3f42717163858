// SPDX-License-Identifier: Apache-2.0
// Draws lines over a view: dashed lines and traced outlines.
#pragma once

#include "apps/operate/view_port.h"
#include "apps/output/silhouette.h"

#include <imgui.h>
#include <vector>

namespace fathom::operate {

// All lengths in pixels of the window.
void dashed(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 colour, float width, float dash);

// Removes points within 0.25 pixels of the line between two kept points: each drawn point costs a dozen
// triangles. Keeps the first and the last point.
void thin(std::vector<ImVec2>& points);

struct Circle {
    float x = 0.0f, y = 0.0f, r = 0.0f;
};
// Fills the union of circles, each pixel once, so that overlaps are not darker.
void fillUnion(ImDrawList& list, const std::vector<Circle>& circles, ImU32 colour);

// width: whole numbers of pixels, for which ImGui needs a third of the triangles.
void outline(ImDrawList& list, const ViewPort& port, const std::vector<OutlineLine>& lines, ImU32 colour,
             float width, bool isDashed);

} // namespace fathom::operate
