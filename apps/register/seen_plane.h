// SPDX-License-Identifier: Apache-2.0
// The plane that depth makes of a flat target, and where the colour camera's rays meet it.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

#include <array>
#include <optional>
#include <vector>

namespace fathom {

// BT.601 luma of the colour picture.
void greyOf(const Frame& frame, std::vector<uint8_t>& grey);

class SeenPlane {
public:
    // Of the depth pixels that the colour camera sees inside a convex outline of its pixels (depth at an edge
    // is the least certain of all). Nothing with fewer than 50 of them, or when they are off their plane by
    // more than 1 % of its distance.
    static std::optional<SeenPlane> inside(const Frame& frame, const CameraInfo& camera,
                                           const std::array<glm::dvec2, 4>& outline);

    // Where the ray of a colour pixel meets it [m], in the depth camera's frame.
    dvec3 at(const glm::dvec2& colourPixel) const;

private:
    CameraInfo camera_;
    dvec3 point_{0.0}, normal_{0.0}; // of the colour camera's frame
};

} // namespace fathom
