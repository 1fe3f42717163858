// SPDX-License-Identifier: Apache-2.0
// Fixture sets from depth images, made on the CPU by the float64 twins of the shaders: classify, surface,
// thin, spheres, hold. So the cases need no GPU and see the regions that the engine would make of the same
// frames.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/reference/hold.h"
#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

#include <optional>

namespace fathom::stability {

// One camera, frame after frame. One thread; allocates.
class ImageFixtures {
public:
    // hold: keep points that a new frame does not contradict for scene.holdSeconds, as the engine does.
    ImageFixtures(const Scene& scene, const CameraInfo& camera, bool hold)
        : scene_(scene)
        , camera_(camera)
        , hold_(hold) {}

    // Positions are about the camera's centre. Generation and frame number are left to the rig.
    Fixtures make(const Frame::Content& frame);

private:
    Scene scene_;
    CameraInfo camera_;
    bool hold_;
    reference::HoldMemory memory_;
    double previousTime_ = 0.0;
};

// One forbidden class of red points with regions of `radius` [m].
Scene redScene(double radius);

} // namespace fathom::stability
