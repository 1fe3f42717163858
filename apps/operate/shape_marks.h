// SPDX-License-Identifier: Apache-2.0
// Draws placed shapes and boxes over a view.
#pragma once

#include "apps/operate/view_port.h"
#include "engine/contact/shapes.h"

namespace fathom::operate {

// Active: as regions of points, red and hatched; of a shape that keeps the tool inside only the outline.
// Ghost: dashed, as a picked colour before it is added.
enum class ShapeLook { Active, Ghost };
void drawShape(ImDrawList& list, const ViewPort& port, const Shape& shape,
               ShapeLook look = ShapeLook::Active);
void drawBox(ImDrawList& list, const ViewPort& port, const Shape& box, ImU32 colour);
// A line between two points of the base frame; skipped when either is behind the eye.
void drawSegment(ImDrawList& list, const ViewPort& port, const dvec3& a, const dvec3& b, ImU32 colour,
                 float width);

} // namespace fathom::operate
