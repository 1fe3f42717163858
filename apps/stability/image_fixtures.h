// SPDX-License-Identifier: Apache-2.0
// Fixture sets from depth images, computed on the CPU by the float64 twins of the shaders classify, surface,
// thin, spheres and hold. The cases need no GPU and get the regions that the engine builds from the same
// frames.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/reference/hold.h"
#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

namespace fathom::stability {

// Turns the frames of one camera into fixture sets. For one thread; allocates.
class ImageFixtures {
public:
    // hold: keep points that no new frame contradicts for scene.holdSeconds, as the engine does.
    ImageFixtures(const Scene& scene, const CameraInfo& camera, bool hold)
        : scene_(scene)
        , camera_(camera)
        , hold_(hold) {}

    // Positions are relative to the camera's centre. The rig sets generation and frame number.
    HostFixtures make(const Frame::Content& frame);

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
