// SPDX-License-Identifier: Apache-2.0
// Decides from which earlier frame the depth estimates of a frame come (estimate.comp).
#pragma once

#include "engine/scene/scene.h"
#include "shaders/shared/frame_params.h"

#include <optional>

namespace fathom::cloud {

// Frame thread only.
class EstimateFrames {
public:
    // Sets the memory members of a frame's parameters. Call for each frame that the passes process, in order.
    // A frame follows none, and starts anew, when either pose is unknown and the scene does not declare the
    // camera static, or when more than 0.25 s lie between them. pose: of the camera; empty when the frame
    // has none. origin [m]: as for setFrame().
    void next(shared::FrameParams& params, const Scene& scene, const std::optional<Pose>& pose,
              const dvec3& origin, double captureTime);
    // The next frame starts anew.
    void forget() { last_.reset(); }

private:
    struct Last {
        Pose pose;
        double time = 0.0; // [s]
    };
    std::optional<Last> last_;
    uint32_t number_ = 0; // of the last frame: 1 to kMemoryFrames - 1
};

} // namespace fathom::cloud
