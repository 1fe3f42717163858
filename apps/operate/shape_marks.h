// SPDX-License-Identifier: Apache-2.0
// Draws authored shapes and boxes as lines over a view.
#pragma once

#include "apps/operate/view_port.h"
#include "engine/contact/shapes.h"

namespace fathom::operate {

void drawShape(ImDrawList& list, const ViewPort& port, const Shape& shape);
void drawBox(ImDrawList& list, const ViewPort& port, const Shape& box, ImU32 colour);
// A line between two points of the base frame; skipped when either is behind the eye.
void drawSegment(ImDrawList& list, const ViewPort& port, const dvec3& a, const dvec3& b, ImU32 colour,
                 float width);

} // namespace fathom::operate
