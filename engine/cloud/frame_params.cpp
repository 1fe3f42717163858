// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/frame_params.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <numeric>

namespace fathom::cloud {

namespace {

using glm::vec4;

// A point with fewer than 2 neighbours this near is isolated. Wide-angle and far images are coarser, so the
// distance grows with the pixel width.
constexpr double kIsolation = 0.020; // [m]
constexpr double kIsolationPixels = 3.0;
constexpr double kGamma = 2.2; // gamma of stored colour bytes

vec4 lensOf(const Intrinsics& lens) {
    return {lens.fx, lens.fy, lens.cx, lens.cy};
}

vec4 distortionOf(const Intrinsics& lens) {
    return {lens.distortion[0], lens.distortion[1], lens.distortion[2], lens.distortion[3]};
}

vec4 divisorOf(const Intrinsics& lens) {
    const double reach = lens.reach();
    return {lens.divisor[0], lens.divisor[1], lens.divisor[2], reach * reach};
}

// Bounds for insideGates (shaders/lib/colour.glsl), widened by the float32 rounding of bounds and products. A
// missing gate gets bounds that every colour passes.
void setGates(shared::ClassParams& c, const FixtureClass& f) {
    constexpr double kIn = 1.0 - 1.9e-7, kOut = 1.0 + 1.9e-7;
    const auto asks = [](const std::optional<Band>& b) { return b && (b->lo > 0.0 || b->hi < 1.0); };
    const bool any = f.hue || asks(f.saturation) || asks(f.lightness);
    const Band s = f.saturation.value_or(Band{0.0, 1.0}), l = f.lightness.value_or(Band{0.0, 1.0});
    const Band h = f.hue.value_or(Band{-1.0, 361.0});
    const bool greyPasses = !f.hue && s.lo <= 0.0;
    c.hue = {h.lo * kIn, h.hi * kOut, h.lo > h.hi ? 1.0 : 0.0, greyPasses ? 0.0 : -1.0};
    c.satLight = {s.lo * kIn, s.hi * kOut, l.lo * 510.0 * kIn, l.hi * 510.0 * kOut};
    c.boxMax.w = any ? -1.0f : 0.0f;
}

// [m] Float32 rounding near a box face at this coordinate, relative to the origin. Points meet a face beyond
// the range only if the camera has left the origin. Then the camera's position, the point and the face are
// each rounded in proportion to their distance.
double faceSlack(double face, double farZ) {
    const double range = std::max(1.0, farZ), away = std::abs(face);
    return 3e-7 * range + (away > range ? 0x1p-22 * away : 0.0);
}

shared::ClassParams classParams(const FixtureClass& f, uint32_t row, const Scene& scene,
                                const dvec3& origin) {
    shared::ClassParams c{};
    setGates(c, f);
    if (f.box) {
        // Widened, so that a point exactly on a face is inside.
        c.boxMin.w = 1.0f;
        for (int a = 0; a < 3; ++a) {
            const double lo = f.box->min[a] - origin[a], hi = f.box->max[a] - origin[a];
            c.boxMin[a] = static_cast<float>(lo - faceSlack(lo, scene.farZ));
            c.boxMax[a] = static_cast<float>(hi + faceSlack(hi, scene.farZ));
        }
    }
    c.role = {f.radius + 3.0 * scene.registrationSigma, f.role == Role::Forbidden ? 1.0 : 0.0,
              f.role == Role::Guidance ? 1.0 : 0.0, row};
    return c;
}

// Widened by the float32 rounding. A range is measured from the camera, so the origin does not matter.
vec4 rangeOf(const FixtureClass& f, double farZ) {
    const double slack = 3e-7 * std::max(1.0, farZ);
    return f.range ? vec4(f.range->lo - slack, f.range->hi + slack, 1.0, 0.0) : vec4(0.0f);
}

// Forbidden classes by radius, largest first, then in file order; four bits each, 15 ends the list.
uint32_t forbiddenOrder(const shared::FrameParams& params) {
    std::vector<uint32_t> order(params.depthBand.z);
    std::iota(order.begin(), order.end(), 0u);
    std::erase_if(order, [&](uint32_t c) { return params.classes[c].role.y == 0.0f; });
    std::ranges::stable_sort(
        order, [&](uint32_t a, uint32_t b) { return params.classes[a].role.x > params.classes[b].role.x; });
    uint32_t packed = 0xffffffffu;
    for (size_t i = 0; i < order.size(); ++i) {
        packed = (packed & ~(15u << (4 * i))) | (order[i] << (4 * i));
    }
    return packed;
}

// Limits of estimates (estimate.glsl). With the filter's, they move no point out of the smallest region
// sphere, up to 33 degrees off the axis. These limit depth, so a point moves farther along an oblique ray:
// there a region of 1 or 2 mm may miss a measured point.
void setMemoryGates(shared::FrameParams& p, double bound) {
    p.memoryGates = {1.0, std::min(0.0004, bound), 0.6, std::min(0.0006, bound)};
    p.memoryLimits = {0.2, std::min(0.0002, 0.25 * bound), 1e-8, 0.0};
}

} // namespace

void setRows(vec4 (&rows)[3], const Pose& pose) {
    const glm::dmat3 r = glm::mat3_cast(pose.rotation); // column-major
    for (int i = 0; i < 3; ++i) {
        rows[i] = vec4(r[0][i], r[1][i], r[2][i], pose.position[i]);
    }
}

std::pair<uint32_t, uint32_t> depthBand(const Scene& scene, double metresPerUnit) {
    const double lo = std::ceil(scene.nearZ / metresPerUnit - 1e-9),
                 hi = std::floor(scene.farZ / metresPerUnit + 1e-9);
    return {static_cast<uint32_t>(std::clamp(lo, 1.0, 65536.0)),
            static_cast<uint32_t>(std::clamp(hi, 0.0, 65535.0))};
}

std::vector<uint32_t> classFixtures(const Scene& scene) {
    std::vector<uint32_t> fixtures;
    for (uint32_t i = 0; i < scene.fixtures.size(); ++i) {
        if (scene.fixtures[i].isPoints()) {
            fixtures.push_back(i);
        }
    }
    return fixtures;
}

shared::FrameParams sceneParams(const Scene& scene, const CameraInfo& camera, const PatchLayout& layout,
                                const dvec3& origin, uint32_t cellEdge, uint32_t cellsAcross) {
    shared::FrameParams p{};
    const std::vector<uint32_t> fixtures = classFixtures(scene);
    p.size = {camera.depth.width, camera.depth.height, layout.across, layout.down};
    p.colourSize = {camera.colour.width, camera.colour.height, cellsAcross, cellEdge};
    const auto [lo, hi] = depthBand(scene, camera.metresPerUnit);
    p.depthBand = {lo, hi, fixtures.size(), 0};
    for (uint32_t c = 0; c < fixtures.size(); ++c) {
        p.classes[c] = classParams(scene.fixtures[fixtures[c]], fixtures[c], scene, origin);
        p.ranges[c] = rangeOf(scene.fixtures[fixtures[c]], scene.farZ);
        p.depthBand.w |= scene.fixtures[fixtures[c]].role == Role::Forbidden ? 1u << c : 0u;
        p.chroma.w |= scene.fixtures[fixtures[c]].usesColour() ? 1u << c : 0u;
    }
    p.time = {0, static_cast<uint32_t>(scene.holdSeconds * 1e6), 0, forbiddenOrder(p)};
    p.lens = lensOf(camera.depth);
    p.distortion = distortionOf(camera.depth);
    p.colourLens = lensOf(camera.colour);
    p.colourDistortion = distortionOf(camera.colour);
    p.lensDivisor = divisorOf(camera.depth);
    p.colourLensDivisor = divisorOf(camera.colour);
    p.depthAndEdges = {camera.depth.distortion[4], camera.colour.distortion[4], camera.metresPerUnit,
                       scene.filter.edge};
    p.filterParams = {1.0 / (2.0 * scene.filter.sigma * scene.filter.sigma), scene.errorBudget, kIsolation,
                      kIsolationPixels / std::min(camera.depth.fx, camera.depth.fy)};
    const double constant = depthSigma(0.0);
    p.noise = {constant, depthSigma(1.0) - constant, 3.0, scene.filterBound()};
    if (camera.beam) {
        p.beam = {camera.beam->range, camera.beam->perMetre, camera.beam->across(), 0.0};
    }
    if (scene.attenuation) {
        // Stored bytes are about light^(1 / 2.2), so their attenuation per metre is that of light divided
        // by 2.2.
        p.water = vec4(glm::vec3(*scene.attenuation / kGamma), 0.0f);
    }
    setRows(p.colourTdepth, camera.colourTdepth);
    const double step = scene.errorBudget / shared::kGrowthSteps;
    p.steps = {1.0 / camera.depth.fx, 1.0 / camera.depth.fy, step, step > 0.0 ? 1.0 / step : 0.0};
    setMemoryGates(p, scene.filterBound());
    return p;
}

void setFrame(shared::FrameParams& params, const Pose& baseTcamera, const dvec3& origin, double captureTime,
              double previousTime) {
    const Pose local{baseTcamera.position - origin, baseTcamera.rotation};
    setRows(params.baseTcamera, local);
    setRows(params.cameraTbase, inverse(local));
    const auto wrapped = [](double seconds) {
        return static_cast<uint32_t>(static_cast<int64_t>(std::llround(seconds * 1e6)));
    };
    params.time.x = wrapped(captureTime);
    params.time.z = wrapped(previousTime);
}

} // namespace fathom::cloud
