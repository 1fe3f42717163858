// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/cell_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace fathom::reference {

namespace {

const double kHalfDiagonal = 0.5 * std::sqrt(3.0);

// Dense surface points; neighbours are at most `spacing` apart.
std::vector<dvec3> surfacePoints(const TriangleMesh& mesh, double spacing) {
    std::vector<dvec3> points;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const dvec3 a = mesh.corner(t, 0), u = mesh.corner(t, 1) - a, v = mesh.corner(t, 2) - a;
        const double longest = std::max({glm::length(u), glm::length(v), glm::distance(u, v)});
        const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
        for (int i = 0; i <= n; ++i) {
            for (int k = 0; k <= n - i; ++k) {
                points.push_back(a + (u * static_cast<double>(i) + v * static_cast<double>(k)) /
                                         static_cast<double>(n));
            }
        }
    }
    return points;
}

using Cell = std::array<int, 3>;

std::set<Cell> occupied(const std::vector<dvec3>& points, const MeshDistance& distance, const dvec3& low,
                        const dvec3& high, double edge) {
    std::set<Cell> cells;
    const dvec3 size = (high - low) / edge;
    const auto last = [](double s) { return std::max(0, static_cast<int>(std::ceil(s - 1e-9)) - 1); };
    const Cell most{last(size.x), last(size.y), last(size.z)};
    for (const dvec3& p : points) {
        const dvec3 at = (p - low) / edge;
        cells.insert({std::min(static_cast<int>(at.x), most[0]), std::min(static_cast<int>(at.y), most[1]),
                      std::min(static_cast<int>(at.z), most[2])});
    }
    for (int x = 0; x <= most[0]; ++x) {
        for (int y = 0; y <= most[1]; ++y) {
            for (int z = 0; z <= most[2]; ++z) {
                if (!cells.contains({x, y, z}) &&
                    distance.isInside(low + edge * dvec3(x + 0.5, y + 0.5, z + 0.5))) {
                    cells.insert({x, y, z});
                }
            }
        }
    }
    return cells;
}

struct Cube {
    dvec3 middle;
    double edge;
    std::vector<dvec3> points;
};

std::vector<Cube> childrenOf(const Cube& cube, const MeshDistance& distance) {
    std::array<Cube, 8> parts;
    for (size_t k = 0; k < 8; ++k) {
        const dvec3 way(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0);
        parts[k] = {cube.middle + 0.25 * cube.edge * way, 0.5 * cube.edge, {}};
    }
    for (const dvec3& p : cube.points) {
        const size_t k = (p.x > cube.middle.x ? 1u : 0u) | (p.y > cube.middle.y ? 2u : 0u) |
                         (p.z > cube.middle.z ? 4u : 0u);
        parts[k].points.push_back(p);
    }
    std::vector<Cube> children;
    for (Cube& part : parts) {
        if (!part.points.empty() || distance.isInside(part.middle)) {
            children.push_back(std::move(part));
        }
    }
    return children;
}

Sphere sphereOf(const Cube& cube, const MeshDistance& distance, double spacing) {
    const Sphere whole{cube.middle, kHalfDiagonal * cube.edge};
    if (cube.points.empty() || distance.isInside(cube.middle)) {
        return whole;
    }
    dvec3 low = cube.points[0], high = low;
    for (const dvec3& p : cube.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    Sphere tight{0.5 * (low + high), 0.0};
    for (const dvec3& p : cube.points) {
        tight.radius = std::max(tight.radius, glm::distance(p, tight.centre));
    }
    tight.radius += 0.6 * spacing; // covers the surface between the points
    return tight.radius < whole.radius ? tight : whole;
}

} // namespace

std::vector<Sphere> gridCover(const TriangleMesh& mesh, const MeshDistance& distance, size_t most) {
    const dvec3 low = mesh.low(), high = mesh.high();
    const dvec3 size = high - low;
    const double longest = std::max({size.x, size.y, size.z});
    const std::vector<dvec3> points = surfacePoints(mesh, longest / 400.0);
    std::vector<Sphere> best;
    for (int n = 1, misses = 0; misses < 3 && n < 200; ++n) { // the count may fall as n rises
        const double edge = longest / n;
        const std::set<Cell> cells = occupied(points, distance, low, high, edge);
        if (cells.size() > most) {
            ++misses;
            continue;
        }
        best.clear();
        for (const Cell& c : cells) {
            best.push_back({low + edge * dvec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5), kHalfDiagonal * edge});
        }
    }
    return best;
}

std::vector<Sphere> octreeCover(const TriangleMesh& mesh, const MeshDistance& distance, size_t most) {
    const dvec3 size = mesh.high() - mesh.low();
    const double longest = std::max({size.x, size.y, size.z}), spacing = longest / 400.0;
    std::vector<Cube> cubes{{0.5 * (mesh.low() + mesh.high()), longest, surfacePoints(mesh, spacing)}};
    std::vector<Cube> done;
    for (size_t next = 0; next < cubes.size(); ++next) { // breadth first: larger cubes come first
        std::vector<Cube> children = childrenOf(cubes[next], distance);
        const size_t count = done.size() + (cubes.size() - next - 1) + children.size();
        if (count > most || cubes[next].edge < 2.0 * spacing) {
            done.push_back(std::move(cubes[next]));
            continue;
        }
        for (Cube& child : children) {
            cubes.push_back(std::move(child));
        }
        cubes[next].points.clear();
    }
    std::vector<Sphere> spheres;
    for (const Cube& cube : done) {
        spheres.push_back(sphereOf(cube, distance, spacing));
    }
    return spheres;
}

} // namespace fathom::reference
