// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/space_view_image.h"

#include "apps/output/silhouette.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <map>

namespace fathom::operate {

namespace {

constexpr double kMaxPixels = 2.5e6; // limit for all spheres of an image together
constexpr double kMaxOverlap = 12.0; // spheres over each other, on average
constexpr double kNearest = 0.02;    // [m]
constexpr float kNothing = 1e9f;     // [m] depth of a pixel without a point

uint32_t dimmed(uint32_t colour) {
    const auto channel = [&](uint32_t shift) {
        return ((colour >> shift & 0xffu) * 215 / 256 + 12) << shift;
    };
    return 0xff000000u | channel(0) | channel(8) | channel(16);
}

} // namespace

void SpaceViewImage::compose(const SceneSnapshot& scene, const SpaceView& view, std::span<const Sphere> arm) {
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
void SpaceViewImage::clear() {
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
    facing_.assign(count, 0.0f);
    bounds_.clear();
}

// Squares of 100 mm below the scene. It has no depth: everything is drawn over it.
void SpaceViewImage::drawGrid(const SpaceView& view) {
    constexpr double kSquare = 0.1; // [m]
    constexpr int kReach = 7;       // squares on each side
    const double end = kReach * kSquare;
    const dvec3 middle(kSquare * std::round(view.orbit.centre.x / kSquare), view.floor,
                       kSquare * std::round(view.orbit.centre.z / kSquare));
    for (int line = -kReach; line <= kReach; ++line) {
        const uint32_t colour = line % 5 == 0 ? 0xff6a5a4cu : 0xff463c34u;
        const double at = line * kSquare;
        drawLine(middle + dvec3(-end, 0.0, at), middle + dvec3(end, 0.0, at), colour);
        drawLine(middle + dvec3(at, 0.0, -end), middle + dvec3(at, 0.0, end), colour);
    }
}

// Between two points of the base frame, the part in front of the eye and inside the image.
void SpaceViewImage::drawLine(const dvec3& from, const dvec3& to, uint32_t colour) {
    dvec3 a = view_.cameraTbase.apply(from), b = view_.cameraTbase.apply(to);
    if (a.z > b.z) {
        std::swap(a, b);
    }
    if (b.z < kNearest) {
        return;
    }
    a = a.z < kNearest ? a + (kNearest - a.z) / (b.z - a.z) * (b - a) : a;
    const glm::dvec2 p = *view_.ofCamera(a), step = *view_.ofCamera(b) - p,
                     size(view_.width(), view_.height());
    double first = 0.0, last = 1.0; // shares of the step that are inside
    for (int k = 0; k < 2; ++k) {
        const double low = -p[k], high = size[k] - 1e-6 - p[k];
        if (step[k] == 0.0) {
            last = low <= 0.0 && high >= 0.0 ? last : -1.0;
            continue;
        }
        first = std::max(first, std::min(low / step[k], high / step[k]));
        last = std::min(last, std::max(low / step[k], high / step[k]));
    }
    const double most =
        std::max(1.0, std::ceil((last - first) * std::max(std::abs(step.x), std::abs(step.y))));
    for (double i = 0.0; i <= most && first <= last; i += 1.0) {
        const glm::dvec2 at =
            glm::clamp(p + (first + (last - first) * i / most) * step, glm::dvec2(0.0), size - 1e-6);
        pixels_[static_cast<size_t>(at.y) * view_.lens.width + static_cast<size_t>(at.x)] = colour;
    }
}

double SpaceViewImage::depthAt(glm::dvec2 p) const {
    if (!(p.x >= 0.0) || !(p.y >= 0.0) || p.x >= view_.width() || p.y >= view_.height()) {
        return 0.0;
    }
    const float z = depth_[static_cast<size_t>(p.y) * view_.lens.width + static_cast<size_t>(p.x)];
    return z < kNothing ? double{z} : 0.0;
}

void SpaceViewImage::splatPoints(const SceneSnapshot& scene) {
    const HostFixtures& set = scene.set;
    const Intrinsics& lens = set.camera.depth;
    if (set.depth.size() != lens.pixels()) {
        return;
    }
    const bool coloured = set.camera.registered && scene.colour.size() == lens.pixels();
    const Pose eyeTcamera = view_.cameraTbase * set.baseTcamera;
    const glm::mat3 rotation = glm::mat3(glm::mat3_cast(eyeTcamera.rotation));
    const glm::vec3 shift(eyeTcamera.position);
    const double perU = 1.0 / lens.fx, perV = 1.0 / lens.fy;
    const auto unit = static_cast<float>(set.camera.metresPerUnit), focal = static_cast<float>(view_.lens.fx);
    const glm::vec2 centre(view_.lens.cx + 0.5, view_.lens.cy + 0.5);
    const float width = static_cast<float>(view_.lens.width) - 1.0f,
                height = static_cast<float>(view_.lens.height) - 1.0f;
    const uint32_t step = std::clamp(lens.width / std::max(1u, view_.lens.width), 1u, 3u); // small view
    for (uint32_t v = 0; v < lens.height; v += step) {
        for (uint32_t u = 0; u < lens.width; u += step) {
            const size_t i = v * lens.width + u;
            if (set.depth[i] == 0) {
                continue;
            }
            const float z = static_cast<float>(set.depth[i]) * unit;
            const glm::dvec2 ray =
                lens.fan ? lens.ray(u, v) : glm::dvec2((u - lens.cx) * perU, (v - lens.cy) * perV);
            const glm::vec3 p = rotation * (z * glm::vec3(glm::vec2(ray), 1.0f)) + shift;
            const glm::vec2 at = centre + focal / p.z * glm::vec2(p);
            if (!(p.z >= static_cast<float>(kNearest) && at.x >= 0.0f && at.y >= 0.0f && at.x < width &&
                  at.y < height)) {
                continue;
            }
            const bool forbidden = set.forbiddenAt(u, v);
            putPoint(static_cast<size_t>(at.y) * view_.lens.width + static_cast<size_t>(at.x), p.z,
                     forbidden  ? 0xff3c4af0u
                     : coloured ? dimmed(scene.colour[i])
                                : 0xffa09890u);
        }
    }
}

// 2x2 pixels, so that near surfaces have no holes.
void SpaceViewImage::putPoint(size_t first, float z, uint32_t colour) {
    for (const size_t at : {first, first + 1, first + view_.lens.width, first + view_.lens.width + 1}) {
        const bool nearer = z < depth_[at];
        depth_[at] = nearer ? z : depth_[at];
        pixels_[at] = nearer ? colour : pixels_[at];
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
    const auto size = static_cast<float>(radius), z = static_cast<float>(c.z);
    const auto perSquare = static_cast<float>(1.0 / (r * r));
    for (int y = top; y <= bottom; ++y) {
        const double dy = y - y0, half = std::sqrt(std::max(0.0, r * r - dy * dy));
        const int left = std::max(0, static_cast<int>(x0 - half)),
                  right = std::min(width - 1, static_cast<int>(x0 + half));
        const float rest = 1.0f - static_cast<float>(dy * dy) * perSquare;
        const auto from = static_cast<float>(left - x0);
        const size_t row = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(left);
        for (int i = 0; i <= right - left; ++i) { // without branches, for several pixels at once
            const float dx = from + static_cast<float>(i);
            const float up = std::sqrt(std::max(0.0f, rest - dx * dx * perSquare));
            put(row + static_cast<size_t>(i), up, z - size * up);
        }
    }
}

} // namespace

// Opaque and in one colour, to differ from regions and points.
void SpaceViewImage::splatArm(std::span<const Sphere> arm) {
    float* const depth = depth_.data();
    uint32_t* const pixels = pixels_.data();
    for (const Sphere& sphere : arm) {
        const dvec3 c = view_.cameraTbase.apply(sphere.centre);
        if (c.z < sphere.radius + kNearest) {
            continue;
        }
        splat(view_.lens, c, sphere.radius, [depth, pixels](size_t at, float up, float z) {
            const bool nearer = z < depth[at];
            depth[at] = nearer ? z : depth[at];
            const int level = static_cast<int>(70.0f + 130.0f * up); // at most 200
            const int colour = level << 16 | level << 8 | level;
            pixels[at] = nearer ? 0xff280e00u + static_cast<uint32_t>(colour) : pixels[at];
        });
    }
}

void SpaceViewImage::splatRegions(const HostFixtures& set) {
    float *const front = front_.data(), *const facing = facing_.data();
    double cost = 0.0;
    for (size_t i = 0; i < set.spheres.size(); i += 8) {
        const double z = std::max(kNearest, view_.cameraTbase.apply(regionCentre(set, i)).z);
        const double r = view_.lens.fx * double{set.spheres.radius[i]} / z;
        cost += 8.0 * 3.14 * r * r;
    }
    const double most = std::min(kMaxPixels, kMaxOverlap * static_cast<double>(pixels_.size()));
    const size_t step = std::max<size_t>(1, static_cast<size_t>(std::ceil(cost / most)));
    for (size_t i = 0; i < set.spheres.size(); i += step) {
        const dvec3 c = view_.cameraTbase.apply(regionCentre(set, i));
        const double radius = double{set.spheres.radius[i]};
        if (c.z < radius + kNearest) {
            continue;
        }
        splat(view_.lens, c, radius, [front, facing](size_t at, float up, float z) {
            const bool nearer = z < front[at];
            front[at] = nearer ? z : front[at];
            facing[at] = nearer ? up : facing[at];
        });
    }
}

void SpaceViewImage::shadeRegions() {
    const size_t width = view_.lens.width;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        if (front_[i] >= depth_[i]) {
            continue;
        }
        const bool line = (i % width + i / width) % 12 < 2;
        const int share = line ? 150 : 96;
        const int shade = 60 + static_cast<int>(195.0f * facing_[i]);
        const int red = 90 + 160 * shade / 255, rest = 40 * shade / 255;
        const auto mix = [&](uint32_t shift, int value) {
            const int under = static_cast<int>(pixels_[i] >> shift & 0xffu);
            return static_cast<uint32_t>(under + (value - under) * share / 256) << shift;
        };
        pixels_[i] = 0xff000000u | mix(0, red) | mix(8, rest) | mix(16, rest);
    }
}

// The engine's tree exists on the device only. These are the same blocks of pixels, bounded around their
// centroid.
void SpaceViewImage::boundBlocks(const HostFixtures& set, int level) {
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
