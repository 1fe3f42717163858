// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/surface.comp: rejection of flying and isolated pixels, the paper's Cartesian bilateral
// filter (eq. 1-2), base frame.
#pragma once

#include "engine/reference/frame_view.h"

namespace fathom::reference {

struct SurfaceImage {
    PointImage points;
    // 1: a distance or depth is within 1e-6 (relative or metres) of its threshold
    std::vector<uint8_t> unsure;
};

// Computes the points of the pixels with a class (masks != 0). Flying: nearer than all neighbours on one side
// by more than filter.edge (relative) and farther than all on the opposite side. Isolated: fewer than 2 of
// the 8 neighbours within 20 mm, or within three pixels' width where the frame is coarser.
SurfaceImage surface(const FrameView& view, std::span<const uint32_t> masks);

} // namespace fathom::reference
