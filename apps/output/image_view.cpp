// SPDX-License-Identifier: Apache-2.0
#include "apps/output/image_view.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kNearest = 1e-3; // [m] smallest distance in front of the camera
constexpr int kMostRows = 4096;   // of an enlarged image; cairo draws at most 32767

glm::dvec2 pinhole(const Intrinsics& lens, const dvec3& point) {
    return {lens.cx + lens.fx * point.x / point.z, lens.cy + lens.fy * point.y / point.z};
}

} // namespace

std::optional<glm::dvec2> ImageView::ofCamera(const dvec3& point) const {
    if (!(point.z >= kNearest)) {
        return std::nullopt;
    }
    const glm::dvec2 centre = pinhole(lens, point); // pixel centres are at integers
    const double factor = scale;
    return (centre + 0.5) * factor + distortionShift(point);
}

glm::dvec2 ImageView::distortionShift(const dvec3& point) const {
    if (lens.pinhole()) {
        return glm::dvec2(0.0);
    }
    const glm::dvec2 straight = pinhole(lens, point);
    // The distortion polynomial is valid only in and near the image.
    const double marginU = 0.5 * lens.width, marginV = 0.5 * lens.height;
    const bool near = straight.x > -marginU && straight.x < lens.width + marginU && straight.y > -marginV &&
                      straight.y < lens.height + marginV;
    const glm::dvec2 bent = lens.project(point);
    return near && bent.x != Intrinsics::kUnseen ? (bent - straight) * static_cast<double>(scale)
                                                 : glm::dvec2(0.0);
}

ImageView imageView(const CameraInfo& camera, const Pose& baseTcamera, bool ofDepth, int leastWidth) {
    ImageView view;
    view.lens = ofDepth ? camera.depth : camera.colour;
    view.cameraTbase = inverse(baseTcamera);
    if (!ofDepth && !camera.registered) {
        view.cameraTbase = camera.colourTdepth * view.cameraTbase;
    }
    const int width = std::max(1, static_cast<int>(view.lens.width));
    const int height = std::max(1, static_cast<int>(view.lens.height));
    view.scale = std::max(1, std::min((leastWidth + width - 1) / width, kMostRows / height));
    return view;
}

} // namespace fathom
