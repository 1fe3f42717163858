// SPDX-License-Identifier: Apache-2.0
// The spheres of points that the frame shows, from their depths alone: across a bus go four bytes per
// sphere instead of sixteen. The same operations in the same order as on the device (rayOf, pointAt,
// transformPoint and growthOf in shaders/), so that host and device have the same spheres to the last bit.
#pragma once

#include "engine/scene/plan.h"
#include "shaders/shared/frame_params.h"

#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace fathom::cloud {

// Rays (x/z, y/z) of a frame's pixels, row-major, as passes read them where they are not linear in the
// pixel.
std::vector<glm::vec2> raysOf(const Intrinsics& lens);

class SeenPoints {
public:
    SeenPoints(const Intrinsics& lens, const PatchLayout& layout);
    // What the passes of the frame that is collected read. Nobody takes points meanwhile.
    void setFrame(const shared::FrameParams& params);

    // Base-frame points about the origin [m] of slots (0..255) of a patch with these depths [m]. Any thread,
    // without allocation.
    void put(uint32_t patch, std::span<const uint16_t> slots, const float* depths, float* x, float* y,
             float* z) const noexcept;
    float radiusOf(size_t pointClass) const noexcept { return frame_.classes[pointClass].role.x; } // [m]
    float step() const noexcept { return frame_.steps.z; } // [m] of what a sphere grows by

private:
    uint32_t across_, width_;
    std::vector<float> column_, row_; // x/z of a column's rays, y/z of a row's, of whole patches
    std::vector<glm::vec2> rays_;     // else of each pixel
    bool linear_;
    shared::FrameParams frame_{};
};

} // namespace fathom::cloud
