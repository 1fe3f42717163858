// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/gripper.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr dvec3 kPalm{0.045, 0.02, 0.012}; // [m] half edges

struct Round { // a capsule [m]
    dvec3 from, to;
    double radius;
};
constexpr Round kRoundParts[] = {{{0, 0, 0.02}, {0, 0, 0.1}, 0.018},
                                 {{0.035, 0, -0.01}, {0.035, 0, -0.06}, 0.008},
                                 {{-0.035, 0, -0.01}, {-0.035, 0, -0.06}, 0.008}};

constexpr uint32_t kAround = 48, kRings = 24; // facets around a capsule; rings of its two half balls

void addTriangle(TriangleMesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
    if (mesh.points[a] != mesh.points[b] && mesh.points[b] != mesh.points[c] &&
        mesh.points[c] != mesh.points[a]) {
        mesh.triangles.push_back({a, b, c});
    }
}

void addBox(TriangleMesh& mesh, const dvec3& half) {
    const auto first = static_cast<uint32_t>(mesh.points.size());
    for (uint32_t k = 0; k < 8; ++k) {
        mesh.points.push_back({(k & 1) != 0 ? half.x : -half.x, (k & 2) != 0 ? half.y : -half.y,
                               (k & 4) != 0 ? half.z : -half.z});
    }
    constexpr uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& f : kFaces) {
        addTriangle(mesh, first + f[0], first + f[1], first + f[2]);
        addTriangle(mesh, first + f[0], first + f[2], first + f[3]);
    }
}

// Adds a capsule along z. The corners are outside it, so that the facets between them do not cut it.
void addCapsule(TriangleMesh& mesh, const Round& r) {
    const auto first = static_cast<uint32_t>(mesh.points.size());
    const double low = std::min(r.from.z, r.to.z), high = std::max(r.from.z, r.to.z);
    const double radius = r.radius / (std::cos(M_PI / kAround) * std::cos(M_PI / kAround));
    for (uint32_t ring = 0; ring <= kRings + 1; ++ring) {
        const bool upper = ring > kRings / 2;
        const double tilt = M_PI * (upper ? ring - 1 : ring) / kRings; // from -z
        const double z = (upper ? high : low) - radius * std::cos(tilt);
        const bool pole = ring == 0 || ring == kRings + 1;
        for (uint32_t k = 0; k < kAround; ++k) {
            const double a = 2.0 * M_PI * k / kAround, out = pole ? 0.0 : radius * std::sin(tilt);
            mesh.points.push_back({r.from.x + out * std::cos(a), r.from.y + out * std::sin(a), z});
        }
    }
    for (uint32_t ring = 0; ring <= kRings; ++ring) {
        for (uint32_t k = 0; k < kAround; ++k) {
            const uint32_t next = (k + 1) % kAround, below = first + ring * kAround, above = below + kAround;
            addTriangle(mesh, below + k, below + next, above + next);
            addTriangle(mesh, below + k, above + next, above + k);
        }
    }
}

// One sphere per cell of a cubic grid with edge `cell` [m]; the radius is share * cell.
std::vector<Sphere> cover(const std::vector<Solid>& shape, double cell, double share) {
    std::vector<Sphere> spheres;
    const double radius = share * cell;
    for (double z = -0.07 - 0.5 * cell; z <= 0.12 + cell; z += cell) {
        for (double y = -cell * std::floor(0.022 / cell + 0.5); y <= 0.022 + cell; y += cell) {
            for (double x = -cell * std::floor(0.048 / cell + 0.5); x <= 0.048 + cell; x += cell) {
                if (distanceTo(shape, {x, y, z}) < 0.866 * cell) {
                    spheres.push_back({{x, y, z}, radius});
                }
            }
        }
    }
    return spheres;
}

} // namespace

std::vector<Solid> gripper() {
    const Paint paint;
    const Pose palm{dvec3(0.0), dquat(1, 0, 0, 0)};
    std::vector<Solid> shape{boxAt(palm, kPalm, paint)};
    for (const Round& r : kRoundParts) {
        shape.push_back(capsuleBetween(r.from, r.to, r.radius, paint));
    }
    return shape;
}

double distanceTo(const std::vector<Solid>& shape, const dvec3& p) {
    double least = HUGE_VAL;
    for (const Solid& s : shape) {
        least = std::min(least, signedDistance(s, p));
    }
    return least;
}

TriangleMesh gripperMesh() {
    TriangleMesh mesh;
    addBox(mesh, kPalm);
    for (const Round& r : kRoundParts) {
        addCapsule(mesh, r);
    }
    tidy(mesh, 0.0);
    return mesh;
}

std::vector<Sphere> coverWith(const std::vector<Solid>& shape, size_t most, double share) {
    double fine = 0.002, coarse = 0.12;
    for (int i = 0; i < 18; ++i) {
        const double middle = std::sqrt(fine * coarse);
        (cover(shape, middle, share).size() > most ? fine : coarse) = middle;
    }
    return cover(shape, coarse, share);
}

Fit fitOf(const std::vector<Solid>& shape, const std::vector<Sphere>& spheres) {
    Fit fit;
    for (const Sphere& s : spheres) {
        for (int k = 0; k < 200; ++k) {
            const double z = 1.0 - (2.0 * k + 1.0) / 200.0, a = 2.399963229728653 * k,
                         ring = std::sqrt(1.0 - z * z);
            fit.protrusion = std::max(
                fit.protrusion,
                distanceTo(shape, s.centre + s.radius * dvec3(ring * std::cos(a), ring * std::sin(a), z)));
        }
    }
    for (double z = -0.07; z <= 0.12; z += 0.002) {
        for (double y = -0.022; y <= 0.022; y += 0.002) {
            for (double x = -0.048; x <= 0.048; x += 0.002) {
                if (distanceTo(shape, {x, y, z}) > 0.0) {
                    continue;
                }
                double least = HUGE_VAL;
                for (const Sphere& s : spheres) {
                    least = std::min(least, glm::length(dvec3(x, y, z) - s.centre) - s.radius);
                }
                fit.gap = std::max(fit.gap, least);
            }
        }
    }
    return fit;
}

} // namespace fathom::profile
