// SPDX-License-Identifier: Apache-2.0
// Input of the float64 twins: scene, camera, pose and row-major images. Every twin of a GPU pass is in
// namespace reference and implements the formulas of the paper, independently of the shader.
#pragma once

#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"

#include <span>
#include <vector>

namespace fathom::reference {

// The point classes of a scene in file order: bit c of a pixel's mask is pointClasses(scene)[c].
std::vector<const FixtureClass*> pointClasses(const Scene& scene);

// Keeps references: scene, camera and images must outlive it. Rays are computed once.
class FrameView {
public:
    FrameView(const Scene& scene, const CameraInfo& camera, const Pose& baseTcamera,
              std::span<const uint16_t> depth, std::span<const uint32_t> colour);

    const Scene& scene() const { return scene_; }
    const CameraInfo& camera() const { return camera_; }
    const Pose& baseTcamera() const { return baseTcamera_; }
    int width() const { return static_cast<int>(camera_.depth.width); }
    int height() const { return static_cast<int>(camera_.depth.height); }
    size_t pixels() const { return depth_.size(); }
    size_t index(int u, int v) const {
        return static_cast<size_t>(v) * camera_.depth.width + static_cast<size_t>(u);
    }

    // Depth [m]; 0 outside the image and without a measurement in near..far. The bounds are inclusive; a
    // tolerance of 1e-9 depth units absorbs the rounding of near / unit.
    double z(int u, int v) const noexcept;
    // Point at depth z [m] on the pixel's ray, camera frame.
    dvec3 point(int u, int v, double z) const noexcept;
    uint32_t colour(int u, int v) const {
        return colour_[static_cast<size_t>(v) * camera_.colour.width + static_cast<size_t>(u)];
    }

    // The colour image shows nothing.
    bool dark() const { return dark_; }

private:
    const Scene& scene_;
    const CameraInfo& camera_;
    Pose baseTcamera_;
    bool dark_ = false;
    std::span<const uint16_t> depth_;
    std::span<const uint32_t> colour_;
    std::vector<glm::dvec2> rays_;
};

// Points of a frame, row-major, base frame [m]; z = depth along the optical axis, 0 = no point.
struct PointImage {
    std::vector<dvec3> at;
    std::vector<double> z;
};

// The pixel nearest to the projection of a camera-frame point (z > 0), and whether that choice depends on
// less than slack [pixels].
struct NearestPixel {
    int u = 0, v = 0;
    bool unsure = false;
    double fu = 0.0, fv = 0.0; // the exact projection [pixels]
};
NearestPixel nearestPixel(const Intrinsics& lens, const dvec3& point, double slack);

} // namespace fathom::reference
