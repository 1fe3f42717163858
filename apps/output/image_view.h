// SPDX-License-Identifier: Apache-2.0
// Projects points of the base frame into an enlarged camera image.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/pose.h"

#include <optional>

namespace fathom {

// A camera pixel becomes scale x scale pixels. Pixel coordinates refer to the enlarged image, with (0, 0) at
// its top left corner.
struct ImageView {
    Intrinsics lens;
    Pose cameraTbase;
    int scale = 1;

    int width() const { return static_cast<int>(lens.width) * scale; }
    int height() const { return static_cast<int>(lens.height) * scale; }

    // The enlarged pixel of a point [m], with lens distortion; empty when it is not in front of the camera.
    std::optional<glm::dvec2> ofBase(const dvec3& point) const { return ofCamera(cameraTbase.apply(point)); }
    std::optional<glm::dvec2> ofCamera(const dvec3& point) const;
    // The distortion of a camera point with z > 0, relative to the pinhole pixel [enlarged pixels].
    glm::dvec2 distortionShift(const dvec3& point) const;
};

// The view of the colour image, or of the depth image (`ofDepth`), enlarged by the smallest integer factor
// that makes it at least `leastWidth` pixels wide. A narrow image is enlarged less: to at most 4096 rows.
ImageView imageView(const CameraInfo& camera, const Pose& baseTcamera, bool ofDepth, int leastWidth);

} // namespace fathom
