// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/space_ground.h"

#include "apps/replay/silhouette.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <map>

namespace fathom::operate {

namespace {

constexpr double kMaxPixels = 2.5e6; // limit for all spheres of an image together
constexpr double kMostLayers = 12.0; // spheres over each other, on average
constexpr double kNearest = 0.02;    // [m]
constexpr float kNothing = 1e9f;     // [m] depth of a pixel without a point

uint32_t dimmed(uint32_t colour) {
    const auto channel = [&](uint32_t shift) {
        return ((colour >> shift & 0xffu) * 215 / 256 + 12) << shift;
    };
    return 0xff000000u | channel(0) | channel(8) | channel(16);
}

} // namespace

void SpaceGround::compose(const SceneSnapshot& scene, const SpaceView& view, std::span<const Sphere> arm) {
    view_.lens = {};
    view_.lens.width = view.width;
    view_.lens.height = view.height;
    view_.lens.fx = view_.lens.fy = 0.9 * view.width;
    view_.lens.cx = 0.5 * view.width - 0.5;
    view_.lens.cy = 0.5 * view.height - 0.5;
    view_.cameraTbase = inverse(view.orbit.pose());
    view_.scale = 1;
    clear();
    drawGrid(view);
    splatPoints(scene);
    splatArm(arm);
    splatRegions(scene.set);
    shadeRegions();
    if (view.treeLevel >= 0) {
        boundBlocks(scene.set, view.treeLevel);
    }
}

// The background is a vertical gradient.
void SpaceGround::clear() {
    const uint32_t width = view_.lens.width, height = view_.lens.height;
    const size_t count = static_cast<size_t>(width) * height;
    pixels_.resize(count);
    for (uint32_t v = 0; v < height; ++v) {
        const uint32_t level = 16 + 14 * v / height;
        std::fill_n(pixels_.begin() + static_cast<std::ptrdiff_t>(v) * width, width,
                    0xff000000u | (level + 10) << 16 | (level + 4) << 8 | level);
    }
    depth_.assign(count, kNothing);
    front_.assign(count, kNothing);
    shade_.assign(count, 0);
    bounds_.clear();
}

// Squares of 100 mm below the scene. It has no depth: everything is drawn over it.
void SpaceGround::drawGrid(const SpaceView& view) {
    constexpr double kSquare = 0.1, kStep = 0.002; // [m]
    constexpr int kReach = 7;                      // squares on each side
    const double x0 = kSquare * std::round(view.orbit.centre.x / kSquare),
                 z0 = kSquare * std::round(view.orbit.centre.z / kSquare);
    const double end = kReach * kSquare;
    for (int line = -kReach; line <= kReach; ++line) {
        const uint32_t colour = line % 5 == 0 ? 0xff6a5a4cu : 0xff463c34u;
        for (double along = -end; along <= end; along += kStep) {
            for (const bool turned : {false, true}) {
                const double a = turned ? along : line * kSquare, b = turned ? line * kSquare : along;
                const auto p = view_.ofBase({x0 + a, view.floor, z0 + b});
                if (p && p->x >= 0.0 && p->y >= 0.0 && p->x < view_.width() && p->y < view_.height()) {
                    pixels_[static_cast<size_t>(p->y) * view_.lens.width + static_cast<size_t>(p->x)] =
                        colour;
                }
            }
        }
    }
}

double SpaceGround::depthAt(glm::dvec2 p) const {
    if (!(p.x >= 0.0) || !(p.y >= 0.0) || p.x >= view_.width() || p.y >= view_.height()) {
        return 0.0;
    }
    const float z = depth_[static_cast<size_t>(p.y) * view_.lens.width + static_cast<size_t>(p.x)];
    return z < kNothing ? double{z} : 0.0;
}

void SpaceGround::splatPoints(const SceneSnapshot& scene) {
    const Fixtures& set = scene.set;
    const Intrinsics& lens = set.camera.depth;
    if (set.depth.size() != lens.pixels()) {
        return;
    }
    const bool coloured = set.camera.registered && scene.colour.size() == lens.pixels();
    const Pose eyeTcamera = view_.cameraTbase * set.baseTcamera;
    const glm::mat3 rotation = glm::mat3(glm::mat3_cast(eyeTcamera.rotation));
    const glm::vec3 shift(eyeTcamera.position);
    const auto width = static_cast<int>(view_.lens.width), height = static_cast<int>(view_.lens.height);
    const uint32_t step = std::clamp(lens.width / std::max(1u, view_.lens.width), 1u, 3u); // small view
    for (uint32_t v = 0; v < lens.height; v += step) {
        for (uint32_t u = 0; u < lens.width; u += step) {
            const size_t i = v * lens.width + u;
            if (set.depth[i] == 0) {
                continue;
            }
            const auto z = static_cast<float>(set.depth[i] * set.camera.metresPerUnit);
            const glm::dvec2 ray =
                lens.fan ? lens.ray(u, v) : glm::dvec2((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy);
            const glm::vec3 p = rotation * (z * glm::vec3(glm::vec2(ray), 1.0f)) + shift;
            if (p.z < static_cast<float>(kNearest)) {
                continue;
            }
            const int x = static_cast<int>(view_.lens.cx + view_.lens.fx * p.x / p.z + 0.5);
            const int y = static_cast<int>(view_.lens.cy + view_.lens.fy * p.y / p.z + 0.5);
            if (x < 0 || y < 0 || x + 1 >= width || y + 1 >= height) {
                continue;
            }
            const bool forbidden = set.forbiddenAt(u, v);
            const uint32_t colour = forbidden  ? 0xff3c4af0u
                                    : coloured ? dimmed(scene.colour[i])
                                               : 0xffa09890u;
            for (int k = 0; k < 4; ++k) { // 2x2 pixels, so that near surfaces have no holes
                const size_t at = static_cast<size_t>(y + k / 2) * static_cast<size_t>(width) +
                                  static_cast<size_t>(x + k % 2);
                if (p.z < depth_[at]) {
                    depth_[at] = p.z;
                    pixels_[at] = colour;
                }
            }
        }
    }
}

namespace {

// Calls put(pixel, facing, depth) for the pixels of a sphere: facing 1 = towards the eye, depth in [m].
template <class Put>
void splat(const Intrinsics& lens, const dvec3& c, double radius, Put&& put) {
    const auto width = static_cast<int>(lens.width), height = static_cast<int>(lens.height);
    const double r = lens.fx * radius / c.z;
    const double x0 = lens.cx + lens.fx * c.x / c.z, y0 = lens.cy + lens.fy * c.y / c.z;
    const int top = std::max(0, static_cast<int>(y0 - r)),
              bottom = std::min(height - 1, static_cast<int>(y0 + r));
    for (int y = top; y <= bottom; ++y) {
        const double dy = y - y0, half = std::sqrt(std::max(0.0, r * r - dy * dy));
        const int left = std::max(0, static_cast<int>(x0 - half)),
                  right = std::min(width - 1, static_cast<int>(x0 + half));
        for (int x = left; x <= right; ++x) {
            const double dx = x - x0;
            const double up = std::sqrt(std::max(0.0, 1.0 - (dx * dx + dy * dy) / (r * r)));
            put(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x), up,
                static_cast<float>(c.z - radius * up));
        }
    }
}

} // namespace

// Opaque and in one colour, to differ from regions and points.
void SpaceGround::splatArm(std::span<const Sphere> arm) {
    for (const Sphere& sphere : arm) {
        const dvec3 c = view_.cameraTbase.apply(sphere.centre);
        if (c.z < sphere.radius + kNearest) {
            continue;
        }
        splat(view_.lens, c, sphere.radius, [&](size_t at, double up, float z) {
            if (z < depth_[at]) {
                depth_[at] = z;
                const auto level = static_cast<uint32_t>(70.0 + 130.0 * up);
                pixels_[at] = 0xff000000u | std::min(255u, level + 40) << 16 | (level + 14) << 8 | level;
            }
        });
    }
}

void SpaceGround::splatRegions(const Fixtures& set) {
    double cost = 0.0;
    for (size_t i = 0; i < set.spheres.size(); i += 8) {
        const double z = std::max(kNearest, view_.cameraTbase.apply(regionCentre(set, i)).z);
        const double r = view_.lens.fx * double{set.spheres.radius[i]} / z;
        cost += 8.0 * 3.14 * r * r;
    }
    const double most = std::min(kMaxPixels, kMostLayers * static_cast<double>(pixels_.size()));
    const size_t step = std::max<size_t>(1, static_cast<size_t>(std::ceil(cost / most)));
    for (size_t i = 0; i < set.spheres.size(); i += step) {
        const dvec3 c = view_.cameraTbase.apply(regionCentre(set, i));
        const double radius = double{set.spheres.radius[i]};
        if (c.z < radius + kNearest) {
            continue;
        }
        splat(view_.lens, c, radius, [&](size_t at, double up, float z) {
            if (z < front_[at]) {
                front_[at] = z;
                shade_[at] = static_cast<uint8_t>(60.0 + 195.0 * up);
            }
        });
    }
}

void SpaceGround::shadeRegions() {
    const size_t width = view_.lens.width;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        if (front_[i] >= depth_[i]) {
            continue;
        }
        const bool line = (i % width + i / width) % 12 < 2;
        const int share = line ? 150 : 96;
        const int red = 90 + 160 * shade_[i] / 255, rest = 40 * shade_[i] / 255;
        const auto mix = [&](uint32_t shift, int value) {
            const int under = static_cast<int>(pixels_[i] >> shift & 0xffu);
            return static_cast<uint32_t>(under + (value - under) * share / 256) << shift;
        };
        pixels_[i] = 0xff000000u | mix(0, red) | mix(8, rest) | mix(16, rest);
    }
}

// The engine's tree exists on the device only. These are the same blocks of pixels, bounded around their
// centroid.
void SpaceGround::boundBlocks(const Fixtures& set, int level) {
    const uint32_t edge = 4u << (2 * level);
    const uint32_t width = set.camera.depth.width, pixels = set.camera.depth.pixels();
    std::map<uint32_t, std::vector<size_t>> blocks;
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        const uint32_t pixel = set.spheres.source[i] % pixels;
        blocks[(pixel / width / edge) * 4096 + pixel % width / edge].push_back(i);
    }
    for (const auto& [block, members] : blocks) {
        Sphere bound{dvec3(0.0), 0.0};
        for (size_t i : members) {
            bound.centre += regionCentre(set, i) / static_cast<double>(members.size());
        }
        for (size_t i : members) {
            bound.radius = std::max(bound.radius, glm::distance(bound.centre, regionCentre(set, i)) +
                                                      double{set.spheres.radius[i]});
        }
        bounds_.push_back(bound);
    }
}

} // namespace fathom::operate
