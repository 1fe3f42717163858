// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fathom {

namespace {

constexpr double kRounding = 1e-12; // of the radius: a corner on its sphere counts as inside

double gapTo(std::span<const Sphere> spheres, const dvec3& p) {
    double gap = std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) {
        gap = std::min(gap, glm::distance(s.centre, p) - s.radius * (1.0 + kRounding));
    }
    return gap;
}

bool isInSome(std::span<const Sphere> spheres, const dvec3& p, size_t except) {
    for (size_t i = 0; i < spheres.size(); ++i) {
        const dvec3 d = spheres[i].centre - p;
        if (i != except && glm::dot(d, d) < spheres[i].radius * spheres[i].radius) {
            return true;
        }
    }
    return false;
}

// Evenly spread in the unit square and cube (Roberts' R2 and R3 sequences).
double fraction(double x) {
    return x - std::floor(x);
}

void sampleSurface(std::span<const Sphere> spheres, const TriangleMesh& mesh, double samples,
                   CoverMeasure& out) {
    const auto look = [&](const dvec3& p) {
        const double gap = gapTo(spheres, p);
        ++out.surfaceSamples;
        out.outside += gap > 0.0 ? 1 : 0;
        out.deepestGap = std::max(out.deepestGap, gap);
    };
    const double density = samples / mesh.area();
    double owed = 0.5;
    uint64_t n = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            look(mesh.corner(t, k));
        }
        for (owed += density * mesh.area(t); owed >= 1.0; owed -= 1.0, ++n) {
            double u = fraction(0.7548776662466927 * static_cast<double>(n));
            double v = fraction(0.5698402909980532 * static_cast<double>(n));
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            look(mesh.corner(t, 0) + u * (mesh.corner(t, 1) - mesh.corner(t, 0)) +
                 v * (mesh.corner(t, 2) - mesh.corner(t, 0)));
        }
    }
}

void sampleUnion(std::span<const Sphere> spheres, const MeshDistance& distance, double samples,
                 CoverMeasure& out) {
    const auto each =
        static_cast<size_t>(std::clamp(samples / static_cast<double>(spheres.size()), 48.0, 20'000.0));
    double sum = 0.0, weight = 0.0;
    for (size_t i = 0; i < spheres.size(); ++i) {
        const Sphere& s = spheres[i];
        out.bound = std::max(out.bound, distance.signedDistance(s.centre) + s.radius);
        for (size_t k = 0; k < each; ++k) {
            const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(each);
            const double turn = 2.0 * std::numbers::pi * 0.6180339887498949 * static_cast<double>(k);
            const double across = std::sqrt(1.0 - z * z);
            const dvec3 p = s.centre + s.radius * dvec3(across * std::cos(turn), across * std::sin(turn), z);
            if (isInSome(spheres, p, i)) {
                continue;
            }
            const double d = distance.signedDistance(p);
            if (d > 0.0) {
                out.protrusionMax = std::max(out.protrusionMax, d);
                sum += s.radius * s.radius * d;
                weight += s.radius * s.radius;
            }
        }
    }
    out.protrusionMean = weight > 0.0 ? sum / weight : 0.0;
}

void sampleVolume(std::span<const Sphere> spheres, const MeshDistance& distance, double samples,
                  CoverMeasure& out) {
    dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const Sphere& s : spheres) {
        low = glm::min(low, s.centre - s.radius);
        high = glm::max(high, s.centre + s.radius);
    }
    double ofUnion = 0.0, ofMesh = 0.0, both = 0.0;
    for (double n = 0.0; n < samples; ++n) {
        const dvec3 u(fraction(0.8191725133961645 * n), fraction(0.6710436067037893 * n),
                      fraction(0.5497004779019703 * n));
        const dvec3 p = low + u * (high - low);
        const bool held = isInSome(spheres, p, spheres.size());
        const bool inside = distance.isInside(p);
        ofUnion += held ? 1.0 : 0.0;
        ofMesh += inside ? 1.0 : 0.0;
        both += held && inside ? 1.0 : 0.0;
    }
    out.volumeRatio = ofMesh > 0.0 ? ofUnion / ofMesh : 0.0;
    out.insideCovered = ofMesh > 0.0 ? both / ofMesh : 1.0;
}

} // namespace

CoverMeasure measureCover(std::span<const Sphere> spheres, const TriangleMesh& mesh,
                          const MeshDistance& distance, double effort) {
    CoverMeasure out;
    if (spheres.empty()) {
        return out;
    }
    sampleSurface(spheres, mesh, 100'000.0 * effort, out);
    sampleUnion(spheres, distance, 40'000.0 * effort, out);
    if (distance.solid()) {
        sampleVolume(spheres, distance, 100'000.0 * effort, out);
    }
    return out;
}

} // namespace fathom
