// SPDX-License-Identifier: Apache-2.0
// A plane fitted to the depth of a flat target, intersected with rays of the colour camera.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

#include <array>
#include <optional>
#include <vector>

namespace fathom {

// BT.601 luma of the colour image.
void greyOf(const Frame& frame, std::vector<uint8_t>& grey);

class SeenPlane {
public:
    // Fits the depth pixels that project inside a convex outline in the colour image; depth is least certain
    // at edges. Empty with fewer than 50 pixels, or when they deviate from the plane by more than 1 % of its
    // distance.
    static std::optional<SeenPlane> inside(const Frame& frame, const CameraInfo& camera,
                                           const std::array<glm::dvec2, 4>& outline);

    // Intersection of a colour pixel's ray with the plane [m], in the depth camera's frame.
    dvec3 at(const glm::dvec2& colourPixel) const;

private:
    CameraInfo camera_;
    dvec3 point_{0.0}, normal_{0.0}; // of the colour camera's frame
};

} // namespace fathom
