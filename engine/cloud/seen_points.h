// SPDX-License-Identifier: Apache-2.0
// Computes the spheres of seen points from their depths, so that 4 bytes per sphere cross the bus instead
// of 16. Uses the same operations in the same order as the device (rayOf, pointAt, transformPoint and
// growthOf in shaders/), so that host and device agree to the last bit.
#pragma once

#include "engine/scene/plan.h"
#include "shaders/shared/frame_params.h"

#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace fathom::cloud {

// Rays (x/z, y/z) of all pixels, row-major: the table that passes read when rays are not linear in the pixel.
std::vector<glm::vec2> raysOf(const Intrinsics& lens);

class SeenPoints {
public:
    SeenPoints(const Intrinsics& lens, const PatchLayout& layout);
    // Sets the parameters of the frame to collect. No put() may run at the same time.
    void setFrame(const shared::FrameParams& params);

    // Writes the points of slots (0..255) of a patch with these depths [m]: base axes, relative to the origin
    // [m]. Any thread; does not allocate.
    void put(uint32_t patch, std::span<const uint16_t> slots, const float* depths, float* x, float* y,
             float* z) const noexcept;
    float radiusOf(size_t pointClass) const noexcept { return frame_.classes[pointClass].role.x; } // [m]
    float step() const noexcept { return frame_.steps.z; } // [m] growth step of spheres

private:
    uint32_t across_, width_;
    std::vector<float> column_, row_; // x/z per column, y/z per row, up to whole patches
    std::vector<glm::vec2> rays_;     // for other lenses, per pixel
    bool linear_;
    shared::FrameParams frame_{};
};

} // namespace fathom::cloud
