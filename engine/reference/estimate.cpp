// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/estimate.h"

#include <algorithm>
#include <cmath>

namespace fathom::reference {

namespace {

constexpr double kMargin = 1e-6, kDriftMargin = 4e-6; // [m] drift is stored in steps of 1 um

// a <= b; unsure when they are within the margin.
bool within(double a, double b, bool& unsure, double margin = kMargin) {
    unsure = unsure || std::abs(a - b) < margin;
    return a <= b;
}

uint32_t forbiddenBits(const Scene& scene) {
    uint32_t bits = 0, c = 0;
    for (const FixtureClass* f : pointClasses(scene)) {
        bits |= f->role == Role::Forbidden ? 1u << c : 0u;
        ++c;
    }
    return bits;
}

} // namespace

// The estimate of the surface point that the pixel shows: bilinear between the four pixels around it in the
// frame before, if all have one within 9 sigma.
DepthEstimates::Estimate DepthEstimates::carried(const FrameView& view, const Pose& beforeTnow, int u, int v,
                                                 double z, bool& unsure) const {
    const dvec3 q = beforeTnow.apply(view.point(u, v, z));
    if (z == 0.0 || q.z <= 0.0) {
        return {};
    }
    const glm::dvec2 at = view.camera().depth.project(q);
    const double left = std::floor(at.x), top = std::floor(at.y), fx = at.x - left, fy = at.y - top;
    unsure = unsure || std::min({fx, fy, 1.0 - fx, 1.0 - fy}) < 1e-3;
    if (left < 0.0 || top < 0.0 || left + 1.0 >= view.width() || top + 1.0 >= view.height()) {
        return {};
    }
    Estimate sum{0.0, 0.0, 0.0, 0, 255, 0};
    double weight = 0.0;
    bool all = true;
    for (int k = 0; k < 4; ++k) {
        const size_t i = view.index(static_cast<int>(left) + k % 2, static_cast<int>(top) + k / 2);
        const Estimate& e = last_[i];
        const double share = (k % 2 != 0 ? fx : 1.0 - fx) * (k / 2 != 0 ? fy : 1.0 - fy);
        unsure = unsure || unsureLast_[i] != 0;
        sum.mean += share * (e.mean - q.z), sum.shown += share * (e.shown - q.z),
            sum.drift += share * e.drift;
        const bool same = e.weight != 0 && within(std::abs(e.mean - q.z), 9.0 * depthSigma(q.z), unsure);
        all = all && same;
        weight += share * e.weight;
        sum.classes &= e.classes, sum.missed = std::max(sum.missed, e.missed);
    }
    const double sigma = depthSigma(z),
                 added = 1e-8 / (sigma * sigma); // (0.1 mm)^2 for pose and interpolation
    sum.mean += z, sum.shown += z;
    weight = std::max(1.0, weight / (1.0 + weight * added));
    unsure = unsure || std::abs(weight - std::floor(weight) - 0.5) < 1e-4;
    sum.weight = all ? static_cast<uint32_t>(std::lround(weight)) : 0;
    return sum;
}

// The measured depth is more than 3 sigma and 10 mm behind a mean of 8 frames or more, for at most the second
// frame.
bool DepthEstimates::suddenlyFarther(const Scene& scene, const Estimate& e, double raw, bool& unsure) {
    return e.weight >= 8 && e.missed < 2 && (e.classes & forbiddenBits(scene)) != 0 &&
           !within(raw - e.mean, std::max(3.0 * depthSigma(e.mean), 0.01), unsure);
}

DepthEstimates::Estimate DepthEstimates::updated(const Scene& scene, Estimate e, double z, double raw,
                                                 double sigma, bool& unsure) {
    const double bound = scene.filterBound(), most = std::min({sigma, 0.0004, bound});
    const double drift = e.drift + (z - e.mean - e.drift) / 4.0;
    bool same = false;
    if (e.weight != 0) {
        same = within(std::abs(raw - e.mean), 3.0 * sigma, unsure);
        same = within(std::max(drift, -2.0 * drift), std::min({0.6 * sigma, 0.0006, bound}), unsure,
                      kDriftMargin) &&
               same;
    }
    if (!same) {
        return {z, z, 0.0, 1, 0, 0};
    }
    e.weight = std::min(e.weight + 1, scene.filter.memory);
    e.mean = std::clamp(e.mean, z - most, z + most);
    e.mean += (z - e.mean) / e.weight;
    e.drift = std::round(drift * 1e6) * 1e-6;
    if (!within(e.shown, z + most, unsure) ||
        !within(std::abs(e.mean - e.shown), std::min({0.2 * sigma, 0.0002, 0.25 * bound}), unsure)) {
        e.shown = e.mean;
    }
    e.missed = 0;
    return e;
}

DepthEstimates::Estimate DepthEstimates::outlasting(const Scene& scene, Estimate e, double raw, double sigma,
                                                    bool& unsure) {
    const bool agrees = raw == 0.0 || within(std::abs(raw - e.mean), 3.0 * sigma, unsure) ||
                        suddenlyFarther(scene, e, raw, unsure);
    e.classes &= forbiddenBits(scene);
    const bool stays = e.weight != 0 && e.missed < scene.filter.memory && agrees && e.classes != 0;
    ++e.missed;
    return stays ? e : Estimate{};
}

void DepthEstimates::step(const FrameView& view, std::span<const uint8_t> listed,
                          const std::optional<Pose>& before, std::vector<uint32_t>& masks,
                          PointImage& points) {
    last_ = before ? now_ : std::vector<Estimate>();
    last_.resize(view.pixels());
    now_.assign(view.pixels(), Estimate{});
    unsureLast_ = before ? unsure_ : std::vector<uint8_t>();
    unsureLast_.resize(view.pixels());
    unsure_.assign(view.pixels(), 0);
    const Pose beforeTnow = before ? inverse(*before) * view.baseTcamera() : Pose{};
    const bool moved = before && (before->position != view.baseTcamera().position ||
                                  before->rotation != view.baseTcamera().rotation);
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const size_t i = view.index(u, v);
            if (listed[i] == 0) {
                continue;
            }
            const double raw = view.z(u, v), z = points.z[i];
            bool earlier = !moved && unsureLast_[i] != 0, unsure = false;
            Estimate e = moved ? carried(view, beforeTnow, u, v, z != 0.0 ? z : raw, earlier) : last_[i];
            if (z != 0.0 && !suddenlyFarther(view.scene(), e, raw, unsure)) {
                e = updated(view.scene(), e, z, raw, depthSigma(z), unsure);
                e.classes = masks[i];
            } else {
                e = outlasting(view.scene(), e, raw, depthSigma(e.mean), unsure);
            }
            unsure_[i] = unsure || earlier ? 1 : 0;
            now_[i] = e;
            if (e.weight != 0) {
                masks[i] = e.classes;
                points.z[i] = e.shown;
                points.at[i] = view.baseTcamera().apply(view.point(u, v, e.shown));
            } else {
                points.z[i] = 0.0, points.at[i] = dvec3(0.0);
            }
        }
    }
}

} // namespace fathom::reference
