// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_cover.h"

#include "engine/model/cover_fit.h"
#include "engine/model/cover_refine.h"
#include "engine/model/greedy_cover.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr size_t kCentres = 2000;
constexpr double kPieces = 6'000.0; // initial number of pieces
constexpr double kMaxPieces = 2e6;
constexpr double kSlivers = 6.0; // times as many pieces when the surface consists of needles

double edgeFor(const TriangleMesh& mesh, double count) {
    double edge = std::max(std::sqrt(mesh.area() / (0.3 * count)), 1e-12);
    const double most = static_cast<double>(mesh.triangles.size()) + kSlivers * count;
    while (countOfPieces(mesh, edge) > most) {
        edge *= 1.25;
    }
    return edge;
}

// Smallest protrusion for which the greedy cover stays within `leaves`, from above, within `low` .. `high`.
std::vector<Sphere> searchProtrusion(const CoverFitting& f, uint32_t leaves, double low, double high,
                                     int trials) {
    std::vector<Sphere> best;
    for (int k = 0; k < trials; ++k) {
        const double middle = k == 0 && low <= 0.0 ? high : std::sqrt(std::max(low, 1e-4 * high) * high);
        std::vector<Sphere> cover = greedyCover(f.groups, f.centres, middle, leaves);
        if (!cover.empty()) {
            best = std::move(cover);
            high = middle;
        } else {
            low = middle;
        }
    }
    return best;
}

void keepCentres(CoverFitting& f, const std::vector<Sphere>& spheres) {
    for (const Sphere& s : spheres) {
        f.centres.push_back({s.centre, -f.distance.signedDistance(s.centre)});
    }
}

std::vector<Sphere> fitShares(const CoverFitting& f, const std::vector<CoverShare>& shares) {
    std::vector<Sphere> spheres;
    for (const CoverShare& share : shares) {
        spheres.push_back(sphereAround(f, share));
    }
    return fitSpheres(f, spheres);
}

// The best of three starts: greedy for odd shapes, cells of a grid and worst-first halves for regular ones.
std::vector<Sphere> firstCover(const CoverFitting& f, uint32_t leaves) {
    const double whole = glm::distance(f.mesh.low(), f.mesh.high());
    const auto badness = [&f](const CoverShare& share) {
        const dvec3 middle = middleOf(f.pieces, share);
        return protrusionOf(f.distance, {middle, radiusAround(f.pieces, share, middle)});
    };
    std::vector<Sphere> best = fitSpheres(f, searchProtrusion(f, leaves, 0.0, whole, 9));
    for (const auto& shares : {gridShares(f.pieces, leaves), splitShares(f.pieces, leaves, badness)}) {
        std::vector<Sphere> other = fitShares(f, shares);
        if (worstOf(f, other) < worstOf(f, best)) {
            best = std::move(other);
        }
    }
    return best;
}

std::vector<Sphere> coverWithin(CoverFitting& f, uint32_t leaves, uint32_t effort) {
    std::vector<Sphere> best = firstCover(f, leaves);
    for (uint32_t round = 0; round < effort; ++round) {
        const double reached = worstOf(f, best);
        keepCentres(f, best);
        const auto again = searchProtrusion(f, leaves, 0.75 * reached, reached, 3);
        const std::vector<Sphere> fitted = fitSpheres(f, again.empty() ? best : again);
        if (worstOf(f, fitted) < reached) {
            best = fitted;
        }
    }
    return best;
}

CoverFitting makeFitting(const TriangleMesh& mesh, const MeshDistance& distance, double edge) {
    const dvec3 size = mesh.high() - mesh.low();
    const double cell = std::max(2.0 * edge, std::cbrt(size.x * size.y * size.z / 8000.0));
    std::vector<CoverPiece> pieces = cutToPieces(mesh, distance, edge, cell);
    std::vector<CoverCentre> centres = findCentres(mesh, distance, pieces, kCentres);
    PieceGroups groups(pieces);
    return {mesh, distance, std::move(pieces), std::move(groups), std::move(centres)};
}

} // namespace

Cover coverMesh(const TriangleMesh& mesh, const MeshDistance& distance, const CoverOptions& options) {
    double edge = edgeFor(mesh, kPieces);
    if (options.protrusion > 0.0) {
        edge = std::min(edge, 0.5 * options.protrusion);
        if (countOfPieces(mesh, edge) > kMaxPieces) {
            throw Error("a protrusion of " + std::to_string(options.protrusion) +
                        " m is too small for this surface: allow more");
        }
    }
    CoverFitting f = makeFitting(mesh, distance, edge);
    Cover cover;
    if (options.protrusion > 0.0) {
        cover.spheres = greedyCover(f.groups, f.centres, options.protrusion, kMaxLeaves);
        if (cover.spheres.empty()) {
            throw Error("a protrusion of " + std::to_string(options.protrusion) + " m requires more than " +
                        std::to_string(kMaxLeaves) + " spheres: allow more");
        }
        cover.spheres = fitSpheres(f, cover.spheres);
    } else {
        cover.spheres = coverWithin(f, options.leaves, options.effort);
        const double reached = worstOf(f, cover.spheres);
        const double finer = std::max(0.6 * reached, edgeFor(mesh, 6.0 * kPieces));
        if (finer < 0.7 * edge) { // with many leaves, pieces as large as the spheres would waste them
            CoverFitting again = makeFitting(mesh, distance, finer);
            f.pieces = std::move(again.pieces);
            f.groups = std::move(again.groups);
            f.centres = std::move(again.centres);
            keepCentres(f, cover.spheres);
            cover.spheres = coverWithin(f, options.leaves, options.effort);
        }
        cover.spheres = refinedCover(f, cover.spheres, options.leaves);
    }
    cover.protrusionBound = worstOf(f, cover.spheres);
    cover.pieces = f.pieces.size();
    return cover;
}

} // namespace fathom
