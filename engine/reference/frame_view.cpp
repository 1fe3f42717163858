// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/frame_view.h"

#include <cmath>

namespace fathom::reference {

std::vector<const FixtureClass*> pointClasses(const Scene& scene) {
    std::vector<const FixtureClass*> classes;
    for (const FixtureClass& f : scene.fixtures) {
        if (f.isPoints()) {
            classes.push_back(&f);
        }
    }
    return classes;
}

FrameView::FrameView(const Scene& scene, const CameraInfo& camera, const Pose& baseTcamera,
                     std::span<const uint16_t> depth, std::span<const uint32_t> colour)
    : scene_(scene)
    , camera_(camera)
    , baseTcamera_(baseTcamera)
    , depth_(depth)
    , colour_(colour) {
    RawColour image;
    image.width = camera.colour.width, image.height = camera.colour.height;
    image.bytes = std::as_bytes(colour);
    dark_ = isDark(image);
    rays_.reserve(depth.size());
    for (uint32_t v = 0; v < camera.depth.height; ++v) {
        for (uint32_t u = 0; u < camera.depth.width; ++u) {
            rays_.push_back(camera.depth.ray(u, v));
        }
    }
}

double FrameView::z(int u, int v) const noexcept {
    if (u < 0 || v < 0 || u >= width() || v >= height()) {
        return 0.0;
    }
    const double raw = depth_[index(u, v)], unit = camera_.metresPerUnit;
    const bool valid = raw > 0.0 && raw >= scene_.nearZ / unit - 1e-9 && raw <= scene_.farZ / unit + 1e-9;
    return valid ? raw * unit : 0.0;
}

dvec3 FrameView::point(int u, int v, double z) const noexcept {
    const glm::dvec2 ray = rays_[index(u, v)];
    return {ray.x * z, ray.y * z, z};
}

NearestPixel nearestPixel(const Intrinsics& lens, const dvec3& point, double slack) {
    const glm::dvec2 at = lens.project(point);
    NearestPixel p;
    p.fu = at.x, p.fv = at.y;
    p.u = static_cast<int>(std::lround(at.x)), p.v = static_cast<int>(std::lround(at.y));
    const auto atHalf = [&](double x) { return std::abs(std::abs(x - std::round(x)) - 0.5) < slack; };
    p.unsure = atHalf(at.x) || atHalf(at.y);
    return p;
}

} // namespace fathom::reference
