// SPDX-License-Identifier: Apache-2.0
// Where things of the base frame lie in an enlarged picture of the camera.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/pose.h"

#include <optional>

namespace fathom {

// An output pixel is 1 / scale of a camera pixel; pixel coordinates here are of the enlarged picture, with
// (0, 0) at its top left corner.
struct ImageView {
    Intrinsics lens;
    Pose cameraTbase;
    int scale = 1;

    int width() const { return static_cast<int>(lens.width) * scale; }
    int height() const { return static_cast<int>(lens.height) * scale; }

    // Enlarged-picture pixel of a point [m], lens distortion included; empty when it is not in front of the
    // camera.
    std::optional<glm::dvec2> ofBase(const dvec3& point) const { return ofCamera(cameraTbase.apply(point)); }
    std::optional<glm::dvec2> ofCamera(const dvec3& point) const;
    // What the distortion adds to the pinhole pixel of a camera point with z > 0 [enlarged pixels].
    glm::dvec2 distortionShift(const dvec3& point) const;
};

// The view of the colour picture, or of the depth picture (`ofDepth`), enlarged by the least whole factor
// that makes it at least `leastWidth` pixels wide.
ImageView imageView(const CameraInfo& camera, const Pose& baseTcamera, bool ofDepth, int leastWidth);

} // namespace fathom
