// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/simulated_sonar.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kSameEcho = 0.03;   // [m]
constexpr double kWidest = 1.2;      // [rad] from the axis
constexpr float kSpeckle = 0.08f;    // of the strength
constexpr double kViewFocal = 200.0; // [pixels] of the pinhole that rays are cast through

const SimulatedSonarOptions& checked(const SimulatedSonarOptions& o) {
    const bool size = o.width >= 1 && o.width <= 1024 && o.height >= 1 && o.height <= 1024;
    const double widest = 0.5 * o.step * std::max(o.width, o.height) + o.beam.width;
    if (!size || !(o.step > 0.0) || !(widest < kWidest) || !(o.metresPerUnit > 0.0)) {
        throw Error("simulated sonar: 1 to 1024 beams each way within 68 degrees of the axis");
    }
    return o;
}

CameraInfo infoOf(const SimulatedSonarOptions& o) {
    CameraInfo info;
    info.depth.width = o.width;
    info.depth.height = o.height;
    info.depth.fx = info.depth.fy = 1.0 / o.step;
    info.depth.cx = 0.5 * (o.width - 1.0);
    info.depth.cy = 0.5 * (o.height - 1.0);
    info.depth.fan = true;
    info.colour = info.depth;
    info.metresPerUnit = o.metresPerUnit;
    info.beam = o.beam;
    return info;
}

// A pinhole that sees all beams: (u, v) = centre + focal x tangents.
Intrinsics viewOf(const SimulatedSonarOptions& o) {
    const double az = 0.5 * o.step * o.width + o.beam.width, el = 0.5 * o.step * o.height + o.beam.width;
    Intrinsics view;
    view.fx = view.fy = kViewFocal;
    view.width = static_cast<uint32_t>(std::ceil(2.1 * kViewFocal * std::tan(az))) + 2;
    view.height = static_cast<uint32_t>(std::ceil(2.1 * kViewFocal * std::tan(el) / std::cos(az))) + 2;
    view.cx = 0.5 * (view.width - 1.0);
    view.cy = 0.5 * (view.height - 1.0);
    return view;
}

} // namespace

SimulatedSonar::SimulatedSonar(AnalyticScene scene, const SimulatedSonarOptions& options)
    : options_(checked(options))
    , name_(scene.name)
    , info_(infoOf(options_))
    , slots_(info_.depth.pixels(), true, kFramesInFlight + 2) {
    RayCaster caster(std::move(scene), false);
    const Intrinsics view = viewOf(options_);
    caster.setView({}, view);
    for (uint32_t v = 0; v < options_.height; ++v) {
        for (uint32_t u = 0; u < options_.width; ++u) {
            echoes_.push_back(listen(caster, view, u, v));
            axisShare_.push_back(1.0 / glm::length(dvec3(info_.depth.ray(u, v), 1.0)));
        }
    }
}

SimulatedSonar::Echo SimulatedSonar::listen(const RayCaster& caster, const Intrinsics& view, uint32_t u,
                                            uint32_t v) const {
    const double half = 0.5 * options_.beam.width / options_.step; // [beams]
    std::vector<RayCaster::PixelHit> hits;
    double first = HUGE_VAL;
    Echo echo;
    for (int k = 0; k < 9; ++k) {
        const double angle = 0.25 * std::acos(-1.0) * k, out = k == 8 ? 0.0 : half;
        const glm::dvec2 ray = info_.depth.ray(u + out * std::cos(angle), v + out * std::sin(angle));
        const RayCaster::PixelHit hit = caster.cast(view.cx + view.fx * ray.x, view.cy + view.fy * ray.y);
        if (hit.hit.solid < 0) {
            continue;
        }
        hits.push_back(hit);
        if (hit.hit.distance < first) {
            first = echo.range = hit.hit.distance;
            echo.point = options_.baseTscene.apply(hit.ray.origin + first * hit.ray.direction);
            echo.object = caster.scene().solids[static_cast<size_t>(hit.hit.solid)].object;
        }
    }
    for (const RayCaster::PixelHit& hit : hits) {
        if (hit.hit.distance < first + kSameEcho) {
            const Solid& solid = caster.scene().solids[static_cast<size_t>(hit.hit.solid)];
            const dvec3 at = hit.ray.origin + hit.hit.distance * hit.ray.direction;
            const double facing = std::max(0.0, -glm::dot(surfaceNormal(solid, at), hit.ray.direction));
            echo.strength += solid.paint.albedo.r * static_cast<float>(0.4 + 0.6 * facing) / 9.0f;
        }
    }
    return echo;
}

std::optional<Frame> SimulatedSonar::next() {
    if (frame_ >= options_.frames) {
        return std::nullopt;
    }
    FrameSlot* slot = &slots_.acquireFor(description());
    const bool noise = options_.noise;
    for (uint32_t i = 0; i < info_.depth.pixels(); ++i) {
        const Echo& echo = echoes_[i];
        const uint64_t bits = counterBits(options_.seed, frame_, i, NoisePurpose::Depth);
        const bool drop = noise && lowerUniform(bits) < options_.dropShare;
        const double along = options_.beam.range + options_.beam.perMetre * echo.range;
        const double range =
            echo.range +
            (noise ? along * static_cast<double>(normal_(static_cast<uint32_t>(bits >> 44))) : 0.0);
        const double units = std::nearbyint(range * axisShare_[i] / options_.metresPerUnit);
        const bool measured = !drop && echo.range > 0.0 && units >= 1.0 && units <= 65535.0;
        const float speckle =
            noise ? 1.0f + kSpeckle * normal_.coarse(static_cast<uint32_t>(bits >> 30)) : 1.0f;
        const auto grey = static_cast<uint32_t>(
            measured ? 255.0f * std::clamp(echo.strength * speckle, 0.0f, 1.0f) + 0.5f : 0.0f);
        slot->depth()[i] = measured ? static_cast<uint16_t>(units) : uint16_t{0};
        slot->colour()[i] = 0xff000000u | grey << 16 | grey << 8 | grey;
    }
    Frame::Content content;
    content.index = frame_;
    content.sourceNumber = frame_;
    content.captureTime = 0.1 * frame_;
    content.depth = slot->depth();
    content.colour = slot->colour();
    content.baseTcamera = options_.baseTscene;
    ++frame_;
    return slot->lend(content);
}

} // namespace fathom
