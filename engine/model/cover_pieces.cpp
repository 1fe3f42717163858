// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_pieces.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr size_t kMaxHalves = 100'000; // pieces more than triangles

struct Corners {
    dvec3 a, b, c;
};

CoverPiece pieceOf(const Corners& t, size_t triangle) {
    CoverPiece piece{
        {t.a, t.b, t.c}, (t.a + t.b + t.c) / 3.0, 0.0, 0.0, 0.0, static_cast<uint32_t>(triangle)};
    piece.reach = piece.radiusFrom(piece.middle);
    return piece;
}

// The same triangle with a-b as its longest edge.
Corners turned(Corners t) {
    const auto rest = [](const Corners& c) {
        return std::max(glm::distance(c.b, c.c), glm::distance(c.c, c.a));
    };
    while (glm::distance(t.a, t.b) < rest(t)) {
        t = {t.b, t.c, t.a};
    }
    return t;
}

// Cuts a triangle narrower than half an edge across its longest side, into slices of at most three pieces.
// Halving would need (length / edge)^1.6 pieces, because both halves of a needle stay needles.
void slice(const Corners& t, double edge, size_t triangle, std::vector<CoverPiece>& out) {
    const dvec3 along = t.b - t.a;
    const double length = glm::length(along), foot = glm::dot(t.c - t.a, along) / (length * length);
    const auto side = [&](double x) { // on a-c-b
        return x <= foot && foot > 0.0 ? t.a + (t.c - t.a) * (x / foot)
                                       : t.b + (t.c - t.b) * ((1.0 - x) / (1.0 - foot));
    };
    const double count = std::ceil(length / (0.7 * edge));
    for (double i = 0.0; i < count; ++i) {
        const double from = i / count, to = (i + 1.0) / count;
        const dvec3 start = t.a + from * along, far = side(to);
        const bool apex = from < foot && foot < to;
        out.push_back(pieceOf({start, t.a + to * along, far}, triangle));
        out.push_back(pieceOf({start, far, apex ? t.c : side(from)}, triangle));
        if (apex) {
            out.push_back(pieceOf({start, t.c, side(from)}, triangle));
        }
    }
}

bool isNeedle(const Corners& t, double edge) { // of a turned triangle
    const double length = glm::distance(t.a, t.b);
    return length > 8.0 * edge && glm::length(glm::cross(t.b - t.a, t.c - t.a)) < 0.5 * edge * length;
}

// Halves the longest edge until none is too long; calls `done` with each piece until that returns false.
template <typename Done>
void halve(const Corners& whole, double edge, Done done) {
    std::vector<Corners> left{whole};
    while (!left.empty()) {
        const Corners t = turned(left.back());
        left.pop_back();
        if (glm::distance(t.a, t.b) > edge) {
            const dvec3 half = 0.5 * (t.a + t.b);
            left.push_back({t.a, half, t.c});
            left.push_back({half, t.b, t.c});
        } else if (!done(t)) {
            return;
        }
    }
}

Corners cornersOf(const TriangleMesh& mesh, size_t t) {
    return {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
}

// Halves of needles are rounder than slices, so that their spheres protrude less, but there are more.
bool canHalveNeedles(const TriangleMesh& mesh, double edge) {
    size_t left = kMaxHalves + mesh.triangles.size();
    for (size_t t = 0; t < mesh.triangles.size() && left > 0; ++t) {
        halve(cornersOf(mesh, t), edge, [&left](const Corners&) { return --left > 0; });
    }
    return left > 0;
}

// Inward direction, tested just off the surface; zero when both sides or neither side is inside.
dvec3 inwardsAt(const TriangleMesh& mesh, const MeshDistance& distance, uint32_t t, double hair) {
    if (!distance.solid() || t == CoverPiece::kNoTriangle) {
        return dvec3(0.0);
    }
    const dvec3 n = mesh.normal(t),
                middle = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3.0;
    const bool behind = distance.isInside(middle - hair * n), before = distance.isInside(middle + hair * n);
    return behind == before ? dvec3(0.0) : (behind ? -n : n);
}

void addCells(const TriangleMesh& mesh, const MeshDistance& distance, double cell,
              std::vector<CoverPiece>& out) {
    const dvec3 low = mesh.low(), high = mesh.high();
    const double half = 0.5 * std::sqrt(3.0) * cell;
    for (double x = low.x + 0.5 * cell; x < high.x; x += cell) {
        for (double y = low.y + 0.5 * cell; y < high.y; y += cell) {
            for (double z = low.z + 0.5 * cell; z < high.z; z += cell) {
                const dvec3 p(x, y, z);
                // Closer to the surface, the spheres that contain the surface also contain the cell, or it
                // protrudes.
                const double depth = distance.nearest(p).distance;
                if (depth >= half && distance.isInside(p)) {
                    out.push_back({{p, p, p}, p, half, half, depth});
                }
            }
        }
    }
}

// Largest inner ball that touches the surface at p; `n` points inwards.
dvec3 largestBall(const MeshDistance& distance, const dvec3& p, const dvec3& n, double largest) {
    double radius = largest;
    for (int k = 0; k < 30; ++k) {
        const dvec3 centre = p + radius * n;
        const MeshDistance::Nearest q = distance.nearest(centre, radius);
        if (q.distance >= radius * (1.0 - 1e-6)) {
            break;
        }
        const dvec3 way = q.point - p;
        const double along = glm::dot(n, way);
        const double next = along > 0.0 ? glm::dot(way, way) / (2.0 * along) : 0.0;
        if (!(next < radius * (1.0 - 1e-9))) {
            break;
        }
        radius = next;
    }
    return p + radius * n;
}

double golden(size_t i) {
    return std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
}

} // namespace

double CoverPiece::radiusFrom(const dvec3& c) const {
    const dvec3 u = corner[0] - c, v = corner[1] - c, w = corner[2] - c;
    return std::sqrt(std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)})) + margin;
}

double countOfPieces(const TriangleMesh& mesh, double edge) {
    // Halving ends between edge / 2 and edge; a third of edge^2 is what the smallest well-shaped ones have.
    double slivers = 0.0; // a needle is cut along its length, whatever its area
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const dvec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        slivers += longest > edge ? longest / edge : 0.0;
    }
    return static_cast<double>(mesh.triangles.size()) + mesh.area() / (0.16 * edge * edge) + slivers;
}

std::vector<CoverPiece> cutToPieces(const TriangleMesh& mesh, const MeshDistance& distance, double edge,
                                    double cell) {
    std::vector<CoverPiece> pieces;
    const bool halves = canHalveNeedles(mesh, edge);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Corners whole = turned(cornersOf(mesh, t));
        if (!halves && isNeedle(whole, edge)) {
            slice(whole, edge, t, pieces);
        } else {
            halve(whole, edge,
                  [&](const Corners& piece) { return pieces.push_back(pieceOf(piece, t)), true; });
        }
    }
    if (distance.solid()) {
        addCells(mesh, distance, cell, pieces);
    }
    return pieces;
}

std::vector<CoverCentre> findCentres(const TriangleMesh& mesh, const MeshDistance& distance,
                                     const std::vector<CoverPiece>& pieces, size_t count) {
    const dvec3 low = mesh.low(), high = mesh.high();
    const double largest = 0.5 * glm::distance(low, high), hair = 2e-5 * largest;
    std::vector<CoverCentre> centres;
    const auto add = [&](const dvec3& c) { centres.push_back({c, -distance.signedDistance(c)}); };
    add(0.5 * (low + high));
    const double stride =
        std::max(1.0, 2.0 * static_cast<double>(pieces.size()) / static_cast<double>(count));
    for (double at = 0.0; at < static_cast<double>(pieces.size()); at += stride) {
        const CoverPiece& piece = pieces[static_cast<size_t>(at)];
        const dvec3 inwards = inwardsAt(mesh, distance, piece.triangle, hair);
        if (inwards == dvec3(0.0)) {
            add(piece.middle);
            continue;
        }
        const dvec3 centre = largestBall(distance, piece.middle, inwards, largest);
        add(centre);
        add(piece.middle + (0.15 + 0.75 * golden(centres.size())) * (centre - piece.middle));
    }
    return centres;
}

} // namespace fathom
