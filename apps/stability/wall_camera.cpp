// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/wall_camera.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

WallCamera::WallCamera(bool hold, uint64_t seed)
    : camera_(camera())
    , make_(scene(), camera_, hold)
    , rng_(seed) {}

Scene WallCamera::scene() {
    Scene all;
    FixtureClass wall;
    wall.name = "wall";
    wall.radius = kRegion;
    all.fixtures.push_back(wall);
    all.filter.radius = 0;
    all.filter.edge = 0.0;
    return all;
}

CameraInfo WallCamera::camera() {
    CameraInfo info;
    info.depth.width = 160;
    info.depth.height = 120;
    info.depth.fx = info.depth.fy = 140.0;
    info.depth.cx = 79.5;
    info.depth.cy = 59.5;
    info.colour = info.depth;
    info.metresPerUnit = 0.0001;
    info.hasColour = false;
    return info;
}

HostFixtures WallCamera::look(const WallView& look) {
    depth_.assign(camera_.depth.pixels(), 0);
    for (uint16_t& raw : depth_) {
        const double seen = look.z + (look.noise > 0.0 ? look.noise * rng_.normal() : 0.0);
        const bool blind = look.missing > 0.0 && rng_.chance(look.missing);
        raw = blind ? uint16_t{0} : static_cast<uint16_t>(std::lround(seen / camera_.metresPerUnit));
    }
    z_ = look.z;
    time_ += kFrame;
    Frame::Content content;
    content.captureTime = time_;
    content.depth = depth_;
    content.baseTcamera = Pose{};
    return make_.make(content);
}

double WallCamera::largestHole(double x, double y) const {
    double largest = 0.0;
    for (int i = -15; i <= 15; ++i) {
        for (int j = -15; j <= 15; ++j) {
            const double px = x + 0.002 * i, py = y + 0.002 * j;
            const auto cu = static_cast<int>(std::lround(px / z_ * camera_.depth.fx + camera_.depth.cx));
            const auto cv = static_cast<int>(std::lround(py / z_ * camera_.depth.fy + camera_.depth.cy));
            double nearest = 1.0;
            for (int v = std::max(0, cv - 12); v <= std::min(119, cv + 12); ++v) {
                for (int u = std::max(0, cu - 12); u <= std::min(159, cu + 12); ++u) {
                    if (depth_[static_cast<size_t>(v * 160 + u)] != 0) {
                        const glm::dvec2 ray = camera_.depth.ray(u, v);
                        nearest = std::min(nearest, std::hypot(ray.x * z_ - px, ray.y * z_ - py));
                    }
                }
            }
            largest = std::max(largest, nearest);
        }
    }
    return largest;
}

} // namespace fathom::stability
