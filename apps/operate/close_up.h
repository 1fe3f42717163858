// SPDX-License-Identifier: Apache-2.0
// Two small views about the tool without perspective: from the right of the camera and from above. They show
// the depth that the camera view lacks.
#pragma once

#include "apps/operate/depth_cues.h"
#include "apps/operate/layout.h"
#include "engine/contact/shapes.h"

namespace fathom::operate {

enum class CloseUpSide { Right, Top };

// What a view shows. Base frame [m].
struct CloseUp {
    ViewPort port;      // its eye is so far away that perspective does not show
    double reach = 0.0; // [m] from the middle to each edge
    // The regions where the plane through the tool cuts them: circles in the plane, one per small cell. The
    // plane faces the eye and contains the tool's point that is nearest to a region, if one is in the view.
    std::vector<Sphere> section;
    std::vector<dvec3> surface; // points of the camera within 10 mm of the plane, some of many
};

// where: a square of the window. Empty without a tool.
std::optional<CloseUp> closeUp(const HostFixtures& set, const DepthCues& cues, CloseUpSide side,
                               const PixelRect& where);

// Draws the view and records its place as "close-up side" or "close-up top".
void drawCloseUp(Console& console, const CloseUp& view, CloseUpSide side, const DepthCues& cues,
                 std::span<const Shape> shapes, ImFont* font);

// Where both views are, left of the gap bar or above it: takes their squares from `gap`. Both are empty
// without room.
struct CloseUpRooms {
    PixelRect side, top;
};
CloseUpRooms closeUpRooms(PixelRect& gap, float scale);

} // namespace fathom::operate
