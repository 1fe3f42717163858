// SPDX-License-Identifier: Apache-2.0
#include "engine/model/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace fathom {

namespace {

// A piece at least this large relative to the largest is another part of the same kind, such as a second
// finger or a wheel, if it is at most so many of its diagonals or metres away.
constexpr double kLikeSize = 0.25, kLikeDiagonals = 10.0, kLikeDistance = 0.5;

using Triangle = std::array<uint32_t, 3>;
using Edge = std::pair<uint32_t, uint32_t>; // lower index first

Edge edgeOf(const Triangle& t, size_t k) {
    return std::minmax(t[k], t[(k + 1) % 3]);
}

bool goesUp(const Triangle& t, size_t k) {
    return t[k] < t[(k + 1) % 3];
}

using Faces =
    std::map<Edge, std::vector<std::pair<uint32_t, bool>>>; // face, and whether it runs lower -> higher

Faces facesByEdge(const TriangleMesh& mesh) {
    Faces faces;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (size_t k = 0; k < 3; ++k) {
            faces[edgeOf(mesh.triangles[t], k)].emplace_back(t, goesUp(mesh.triangles[t], k));
        }
    }
    return faces;
}

void weldPoints(TriangleMesh& mesh, double weld) {
    const double cell = weld > 0.0 ? weld : 0.0;
    std::map<std::array<double, 3>, uint32_t> known;
    std::vector<dvec3> points;
    std::vector<uint32_t> to(mesh.points.size());
    for (size_t i = 0; i < mesh.points.size(); ++i) {
        const dvec3& p = mesh.points[i];
        std::array<double, 3> key{p.x + 0.0, p.y + 0.0, p.z + 0.0}; // + 0: no negative zero
        for (double& v : key) {
            v = cell > 0.0 ? std::round(v / cell) : v;
        }
        const auto [at, fresh] = known.emplace(key, static_cast<uint32_t>(points.size()));
        if (fresh) {
            points.push_back(p);
        }
        to[i] = at->second;
    }
    mesh.points = std::move(points);
    for (Triangle& t : mesh.triangles) {
        for (uint32_t& corner : t) {
            corner = to[corner];
        }
    }
}

void dropFaces(TriangleMesh& mesh, MeshFacts& facts) {
    std::map<Triangle, bool> known;
    std::vector<Triangle> kept;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        Triangle sorted = t;
        std::ranges::sort(sorted);
        if (sorted[0] == sorted[1] || sorted[1] == sorted[2] || !(mesh.area(i) > 0.0)) {
            ++facts.noArea;
        } else if (!known.emplace(sorted, true).second) {
            ++facts.doubled;
        } else {
            kept.push_back(t);
        }
    }
    mesh.triangles = std::move(kept);
}

// Two faces that share an edge must traverse it in opposite directions.
void turnPart(TriangleMesh& mesh, const Faces& faces, uint32_t seed, std::vector<int8_t>& turned,
              std::vector<uint32_t>& part) {
    turned[seed] = 0;
    part.assign(1, seed);
    for (size_t next = 0; next < part.size(); ++next) {
        const uint32_t t = part[next];
        for (size_t k = 0; k < 3; ++k) {
            const auto& sharing = faces.at(edgeOf(mesh.triangles[t], k));
            if (sharing.size() != 2) {
                continue;
            }
            const auto& [other, up] = sharing[0].first == t ? sharing[1] : sharing[0];
            const bool mine = goesUp(mesh.triangles[t], k);
            if (turned[other] < 0) {
                turned[other] = static_cast<int8_t>((mine == up) != (turned[t] == 1));
                part.push_back(other);
            }
        }
    }
}

double volumeOf(const TriangleMesh& mesh, uint32_t t) {
    return glm::dot(mesh.corner(t, 0), glm::cross(mesh.corner(t, 1), mesh.corner(t, 2))) / 6.0;
}

void turnOutwards(TriangleMesh& mesh, const Faces& faces, MeshFacts& facts) {
    std::vector<int8_t> turned(mesh.triangles.size(), -1);
    std::vector<uint32_t> part;
    for (uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (turned[seed] >= 0) {
            continue;
        }
        turnPart(mesh, faces, seed, turned, part);
        double volume = 0.0;
        for (uint32_t t : part) {
            volume += turned[t] == 1 ? -volumeOf(mesh, t) : volumeOf(mesh, t);
        }
        for (uint32_t t : part) {
            if ((turned[t] == 1) != (volume < 0.0)) {
                std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
                ++facts.turned;
            }
        }
    }
}

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

struct Part {
    dvec3 low{1e300}, high{-1e300};
    double area = 0.0;
    bool main = false;
    uint32_t root = 0;
};

double between(const dvec3& lowA, const dvec3& highA, const dvec3& lowB, const dvec3& highB) {
    return glm::length(glm::max(dvec3(0.0), glm::max(lowA - highB, lowB - highA)));
}

// Pieces by common points, largest area first.
std::vector<Part> partsOf(const TriangleMesh& mesh, std::vector<uint32_t>& parent) {
    parent.resize(mesh.points.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (const Triangle& t : mesh.triangles) {
        parent[rootOf(parent, t[1])] = rootOf(parent, t[0]);
        parent[rootOf(parent, t[2])] = rootOf(parent, t[0]);
    }
    std::map<uint32_t, Part> byRoot;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        Part& part = byRoot[rootOf(parent, mesh.triangles[i][0])];
        part.root = rootOf(parent, mesh.triangles[i][0]);
        part.area += mesh.area(i);
        for (int k = 0; k < 3; ++k) {
            part.low = glm::min(part.low, mesh.corner(i, k));
            part.high = glm::max(part.high, mesh.corner(i, k));
        }
    }
    std::vector<Part> parts;
    for (const auto& [root, part] : byRoot) {
        parts.push_back(part);
    }
    std::ranges::stable_sort(parts, std::greater{}, &Part::area);
    return parts;
}

void keepMain(TriangleMesh& mesh, const std::vector<Part>& parts, std::vector<uint32_t>& parent) {
    std::map<uint32_t, bool> main;
    for (const Part& part : parts) {
        main[part.root] = part.main;
    }
    std::erase_if(mesh.triangles, [&](const Triangle& t) { return !main[rootOf(parent, t[0])]; });
}

} // namespace

double TriangleMesh::area(size_t t) const {
    return 0.5 * glm::length(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
}

dvec3 TriangleMesh::normal(size_t t) const {
    const dvec3 n = glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    const double length = glm::length(n);
    return length > 0.0 ? n / length : dvec3(0.0);
}

double TriangleMesh::area() const {
    double sum = 0.0;
    for (size_t t = 0; t < triangles.size(); ++t) {
        sum += area(t);
    }
    return sum;
}

double TriangleMesh::volume() const {
    double sum = 0.0;
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        sum += volumeOf(*this, t);
    }
    return sum;
}

dvec3 TriangleMesh::low() const {
    dvec3 low(triangles.empty() ? 0.0 : 1e300);
    for (size_t t = 0; t < 3 * triangles.size(); ++t) {
        low = glm::min(low, corner(t / 3, static_cast<int>(t % 3)));
    }
    return low;
}

dvec3 TriangleMesh::high() const {
    dvec3 high(triangles.empty() ? 0.0 : -1e300);
    for (size_t t = 0; t < 3 * triangles.size(); ++t) {
        high = glm::max(high, corner(t / 3, static_cast<int>(t % 3)));
    }
    return high;
}

MeshFacts tidy(TriangleMesh& mesh, double weld) {
    MeshFacts facts;
    facts.faces = mesh.triangles.size();
    weldPoints(mesh, weld);
    dropFaces(mesh, facts);
    const Faces faces = facesByEdge(mesh);
    for (const auto& [edge, sharing] : faces) {
        facts.openEdges += sharing.size() == 1 ? 1 : 0;
        facts.crowdedEdges += sharing.size() > 2 ? 1 : 0;
    }
    turnOutwards(mesh, faces, facts);
    return facts;
}

void findStray(TriangleMesh& mesh, MeshFacts& facts, bool drop) {
    std::vector<uint32_t> parent;
    std::vector<Part> parts = partsOf(mesh, parent);
    facts.parts = parts.size();
    facts.strayParts = parts.size();
    facts.strayFarthest = 0.0;
    if (parts.empty()) {
        return;
    }
    dvec3 low = parts[0].low, high = parts[0].high;
    const double apart = glm::distance(low, high);
    for (bool grown = true; grown;) {
        grown = false;
        for (Part& part : parts) {
            const double size = glm::distance(part.low, part.high);
            const double most =
                size >= kLikeSize * apart ? std::max(kLikeDiagonals * apart, kLikeDistance) : apart;
            if (!part.main && between(part.low, part.high, low, high) <= most && size <= 3.0 * apart) {
                part.main = grown = true;
                --facts.strayParts;
                low = glm::min(low, part.low);
                high = glm::max(high, part.high);
            }
        }
    }
    for (const Part& part : parts) {
        if (!part.main) {
            const double far = glm::length(glm::max(dvec3(0.0), glm::max(low - part.low, part.high - high)));
            facts.strayFarthest = std::max(facts.strayFarthest, far);
        }
    }
    if (drop && facts.strayParts > 0) {
        keepMain(mesh, parts, parent);
    }
}

} // namespace fathom
