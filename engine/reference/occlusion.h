// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/occlusion.comp: the nearest depth that the colour camera sees in each small cell of its
// image.
#pragma once

#include "engine/reference/frame_view.h"

namespace fathom::reference {

// Row-major cells of edge x edge colour pixels; infinity in cells without a depth pixel.
struct CellImage {
    uint32_t edge = 1, across = 1, down = 1;
    std::vector<double> nearest; // [m] along the colour camera's axis
};

// A cell is 1.5 times as wide as the distance between neighbouring depth pixels of a surface that faces both
// cameras.
CellImage emptyCells(const CameraInfo& camera);

// A pixel within slack [colour pixels] of a border between two cells counts for both in `possible` and for
// neither in `sure`, so possible <= truth <= sure in every cell.
struct CellBounds {
    CellImage possible, sure;
};
CellBounds occlusion(const FrameView& view, double slack);

} // namespace fathom::reference
