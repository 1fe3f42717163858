// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/ray_caster.h"

#include "devices/simulated/counter_noise.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

constexpr double kTilePixels = 16.0;
constexpr uint32_t kTextureEdge = 128;   // texels, wraps
constexpr double kTexelsPerMetre = 90.0; // stains of a few centimetres
const dvec3 kLamp(-0.42, -0.55, 0.05);   // [m] scene frame
constexpr uint64_t kTextureSeed = 7;

// Random brightness in -1..1, three octaves, periodic.
std::vector<float> stains() {
    std::vector<float> texture(size_t{kTextureEdge} * kTextureEdge, 0.0f);
    for (uint32_t octave = 0; octave < 3; ++octave) {
        const uint32_t cell = 16u >> octave, cells = kTextureEdge / cell;
        const auto value = [&](uint32_t i, uint32_t j) {
            const uint64_t bits =
                counterBits(kTextureSeed, octave, (j % cells) * cells + i % cells, NoisePurpose::Texture);
            return 2.0f * upperUniform(bits) - 1.0f;
        };
        for (uint32_t y = 0; y < kTextureEdge; ++y) {
            for (uint32_t x = 0; x < kTextureEdge; ++x) {
                const float a = static_cast<float>(x % cell) / static_cast<float>(cell);
                const float b = static_cast<float>(y % cell) / static_cast<float>(cell);
                const float sa = a * a * (3.0f - 2.0f * a), sb = b * b * (3.0f - 2.0f * b);
                const uint32_t i = x / cell, j = y / cell;
                const float top = glm::mix(value(i, j), value(i + 1, j), sa);
                const float bottom = glm::mix(value(i, j + 1), value(i + 1, j + 1), sa);
                texture[y * kTextureEdge + x] +=
                    glm::mix(top, bottom, sb) * 0.55f / static_cast<float>(1u << octave);
            }
        }
    }
    return texture;
}

} // namespace

Water::Water(const WaterOptics& optics)
    : table_(kEntries) {
    for (size_t i = 0; i < kEntries; ++i) {
        const float range = (static_cast<float>(i) + 0.5f) / kEntriesPerMetre;
        table_[i] = {glm::exp(-optics.attenuation * range),
                     optics.veil * (1.0f - glm::exp(-optics.scatter * range))};
    }
}

glm::vec3 Water::seenThrough(const glm::vec3& colour, float range) const noexcept {
    const Step& step = table_[static_cast<size_t>(std::min(range * kEntriesPerMetre, kEntries - 1.0f))];
    return colour * step.left + step.veil;
}

RayCaster::RayCaster(AnalyticScene scene, bool water)
    : scene_(std::move(scene))
    , own_(scene_.solids.size())
    , water_(water && scene_.underwater)
    , texture_(stains()) {
    const TangentGrid lampGrid{-2.5, -2.5, 5.0 / 192, 5.0 / 192, 192, 192};
    lampView_.build(scene_, {kLamp, dquat(1.0, 0.0, 0.0, 0.0)}, lampGrid);
}

void RayCaster::setVisitors(std::span<const Sphere> spheres) {
    const Paint steel{linearColour(150, 154, 158), 0.2f, 0.0f};
    scene_.solids.resize(own_);
    for (const Sphere& s : spheres) {
        scene_.solids.push_back(sphereAt(s.centre, s.radius, steel));
    }
}

void RayCaster::setView(const Pose& sceneTcamera, const Intrinsics& intrinsics) {
    origin_ = sceneTcamera.position;
    sceneRcamera_ = glm::mat3_cast(sceneTcamera.rotation);
    intrinsics_ = intrinsics;
    TangentGrid grid;
    grid.x0 = (-0.5 - intrinsics.cx) / intrinsics.fx;
    grid.y0 = (-0.5 - intrinsics.cy) / intrinsics.fy;
    grid.stepX = kTilePixels / intrinsics.fx;
    grid.stepY = kTilePixels / intrinsics.fy;
    grid.columns = static_cast<uint32_t>(std::ceil(intrinsics.width / kTilePixels));
    grid.rows = static_cast<uint32_t>(std::ceil(intrinsics.height / kTilePixels));
    view_.build(scene_, sceneTcamera, grid);
}

RayHit RayCaster::nearest(const dvec3& direction, std::span<const TileLists::Entry> tile,
                          double axisShare) const noexcept {
    RayHit best{HUGE_VAL, -1};
    for (const TileLists::Entry& entry : tile) {
        if (entry.near > best.distance * axisShare) {
            break; // sorted: later entries cannot be nearer
        }
        const double t = view_.enterSolid(scene_, entry.solid, direction);
        if (t < best.distance) {
            best = {t, static_cast<int32_t>(entry.solid)};
        }
    }
    return best;
}

RayCaster::PixelHit RayCaster::cast(double u, double v) const noexcept {
    const double x = (u - intrinsics_.cx) / intrinsics_.fx, y = (v - intrinsics_.cy) / intrinsics_.fy;
    const double axisShare = 1.0 / std::sqrt(x * x + y * y + 1.0);
    PixelHit pixel;
    pixel.ray = {origin_, (sceneRcamera_[0] * x + sceneRcamera_[1] * y + sceneRcamera_[2]) * axisShare};
    pixel.hit = nearest(pixel.ray.direction, view_.at(x, y), axisShare);
    pixel.depth = pixel.hit.solid < 0 ? 0.0 : pixel.hit.distance * axisShare;
    return pixel;
}

float RayCaster::lampReaches(const dvec3& point, size_t own) const noexcept {
    const dvec3 way = point - kLamp;
    if (way.z <= 1e-3 || !lampView_.inside(way.x / way.z, way.y / way.z)) {
        return 1.0f;
    }
    const double distance = glm::length(way);
    const dvec3 direction = way / distance;
    // A convex solid never shades its own side that faces the lamp.
    const bool convex = scene_.solids[own].kind != SolidKind::Torus;
    for (const TileLists::Entry& entry : lampView_.at(way.x / way.z, way.y / way.z)) {
        if (entry.near > way.z) {
            break;
        }
        if (entry.solid == own && convex) {
            continue;
        }
        const double t = lampView_.enterSolid(scene_, entry.solid, direction);
        if (t < distance - 1e-4) { // ignore the lit surface itself
            return 0.0f;
        }
    }
    return 1.0f;
}

float RayCaster::brightness(const Solid& solid, const dvec3& point) const noexcept {
    if (solid.paint.grime == 0.0f) {
        return 1.0f;
    }
    const dvec3 p = solid.toLocal(point) * kTexelsPerMetre;
    // Long solids run along local z: mixing z into both coordinates textures every side of them.
    const auto x = static_cast<int64_t>(std::floor(p.x + 0.7 * p.z));
    const auto y = static_cast<int64_t>(std::floor(p.y - 0.4 * p.z));
    const float stain =
        texture_[static_cast<size_t>((y & (kTextureEdge - 1)) * kTextureEdge + (x & (kTextureEdge - 1)))];
    return 1.0f + solid.paint.grime * stain;
}

glm::vec3 RayCaster::colour(const PixelHit& pixel) const noexcept {
    if (pixel.hit.solid < 0) {
        return water_ ? waterModel_.seenThrough(scene_.background, 10.0f) : scene_.background;
    }
    const Solid& solid = scene_.solids[static_cast<size_t>(pixel.hit.solid)];
    const dvec3 point = pixel.ray.origin + pixel.hit.distance * pixel.ray.direction;
    const dvec3 normal = surfaceNormal(solid, point);
    const dvec3 toLamp = kLamp - point;
    const double lampDistance = glm::length(toLamp);
    const double facing = std::max(glm::dot(normal, toLamp) / lampDistance, 0.0);
    const float lamp = facing > 0.0 ? lampReaches(point, static_cast<size_t>(pixel.hit.solid)) *
                                          static_cast<float>(1.25 / (0.25 + lampDistance * lampDistance))
                                    : 0.0f;
    const float above = 0.5f - 0.5f * static_cast<float>(normal.y); // y is down
    const float head = std::max(-static_cast<float>(glm::dot(normal, pixel.ray.direction)), 0.0f);
    const float light = 0.10f + 0.16f * above + 0.20f * head + static_cast<float>(facing) * lamp;
    glm::vec3 colour = solid.paint.albedo * brightness(solid, point) * light;
    if (solid.paint.gloss > 0.0f && lamp > 0.0f) {
        const dvec3 middle = glm::normalize(toLamp / lampDistance - pixel.ray.direction);
        const float shine = static_cast<float>(std::max(glm::dot(normal, middle), 0.0));
        const float s2 = shine * shine, s4 = s2 * s2, s8 = s4 * s4, s16 = s8 * s8;
        colour += glm::vec3(solid.paint.gloss * s16 * s16 * lamp);
    }
    return water_ ? waterModel_.seenThrough(colour, static_cast<float>(pixel.hit.distance)) : colour;
}

} // namespace fathom
