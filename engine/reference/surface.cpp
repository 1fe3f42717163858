// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/surface.h"

#include <algorithm>
#include <cmath>

namespace fathom::reference {

namespace {

constexpr double kThreshold = 1e-6;

enum class Side { Neither, Nearer, Farther };

// Classifies the three neighbours on one side by those with depth; Neither when none has depth.
Side sideOf(const FrameView& view, int u, int v, int du, int dv, bool& unsure) {
    const double z = view.z(u, v), edge = view.scene().filter.edge;
    double nearest = HUGE_VAL, farthest = 0.0;
    for (int k = -1; k <= 1; ++k) {
        const double d = view.z(u + du + (du == 0 ? k : 0), v + dv + (dv == 0 ? k : 0));
        if (d != 0.0) {
            nearest = std::min(nearest, d), farthest = std::max(farthest, d);
        }
    }
    if (farthest == 0.0) {
        return Side::Neither;
    }
    unsure = unsure || std::abs(farthest - z * (1.0 - edge)) < kThreshold * z ||
             std::abs(nearest - z * (1.0 + edge)) < kThreshold * z;
    return farthest < z * (1.0 - edge) ? Side::Nearer
                                       : (nearest > z * (1.0 + edge) ? Side::Farther : Side::Neither);
}

bool flying(const FrameView& view, int u, int v, bool& unsure) {
    const auto between = [&](int du, int dv) {
        const Side a = sideOf(view, u, v, du, dv, unsure), b = sideOf(view, u, v, -du, -dv, unsure);
        return (a == Side::Nearer && b == Side::Farther) || (a == Side::Farther && b == Side::Nearer);
    };
    const bool across = between(1, 0), down = between(0, 1);
    return across || down;
}

bool isolated(const FrameView& view, int u, int v, bool& unsure) {
    const double z = view.z(u, v);
    const dvec3 p = view.point(u, v, z);
    const double limit = std::max(0.020, 3.0 * z / std::min(view.camera().depth.fx, view.camera().depth.fy));
    int near = 0;
    for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
            const double d = view.z(u + du, v + dv);
            if ((du == 0 && dv == 0) || d == 0.0) {
                continue;
            }
            const double apart = glm::distance(view.point(u + du, v + dv, d), p);
            near += apart <= limit ? 1 : 0;
            unsure = unsure || std::abs(apart - limit) < kThreshold * std::max(1.0, z);
        }
    }
    return near < 2;
}

double weightOf(const Scene::Filter& filter, double squaredDistance) {
    const double t = squaredDistance / (2.0 * filter.sigma * filter.sigma);
    return filter.weights == Scene::Filter::Weights::Exact ? std::exp(-t)
                                                           : std::pow(std::max(0.0, 1.0 - t / 16.68), 16);
}

double filteredDepth(const FrameView& view, int u, int v) {
    const int r = static_cast<int>(view.scene().filter.radius);
    const dvec3 p0 = view.point(u, v, view.z(u, v));
    double sum = 0.0, weights = 0.0;
    for (int dv = -r; dv <= r; ++dv) {
        for (int du = -r; du <= r; ++du) {
            const double d = view.z(u + du, v + dv);
            if (d != 0.0) {
                const dvec3 apart = view.point(u + du, v + dv, d) - p0;
                const double phi = weightOf(view.scene().filter, glm::dot(apart, apart));
                sum += d * phi;
                weights += phi;
            }
        }
    }
    const double z = view.z(u, v), most = view.scene().filterBound() * z / glm::length(p0);
    return z + std::clamp(sum / weights - z, -most, most);
}

} // namespace

SurfaceImage surface(const FrameView& view, std::span<const uint32_t> masks) {
    SurfaceImage out;
    out.points.at.assign(view.pixels(), dvec3(0.0));
    out.points.z.assign(view.pixels(), 0.0);
    out.unsure.assign(view.pixels(), 0);
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const size_t i = view.index(u, v);
            if (masks[i] == 0) {
                continue;
            }
            bool unsure = false;
            const bool flies = view.scene().filter.edge > 0.0 && flying(view, u, v, unsure);
            const bool alone = view.scene().filter.isolated && isolated(view, u, v, unsure);
            out.unsure[i] = unsure ? 1 : 0;
            if (flies || alone) {
                continue;
            }
            const double z = view.scene().filter.radius > 0 ? filteredDepth(view, u, v) : view.z(u, v);
            out.points.z[i] = z;
            out.points.at[i] = view.baseTcamera().apply(view.point(u, v, z));
        }
    }
    return out;
}

} // namespace fathom::reference
