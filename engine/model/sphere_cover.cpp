// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_cover.h"

#include "engine/model/cover_parts.h"
#include "engine/model/cover_pieces.h"
#include "engine/model/greedy_cover.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr size_t kSeats = 2000;
constexpr double kPieces = 6'000.0; // initial number of pieces
constexpr double kMostPieces = 2e6;
constexpr double kSlivers = 6.0; // times as many pieces when the surface consists of needles

struct Fitting {
    const TriangleMesh& mesh;
    const MeshDistance& distance;
    std::vector<CoverPiece> pieces;
    PieceGroups groups;
    std::vector<CoverSeat> seats;
};

double edgeFor(const TriangleMesh& mesh, double count) {
    double edge = std::max(std::sqrt(mesh.area() / (0.3 * count)), 1e-12);
    const double most = static_cast<double>(mesh.triangles.size()) + kSlivers * count;
    while (countOfPieces(mesh, edge) > most) {
        edge *= 1.25;
    }
    return edge;
}

// Largest protrusion of a sphere, from the signed distance of its centre.
double standsOut(const MeshDistance& distance, const Sphere& s) {
    return distance.signedDistance(s.centre) + s.radius;
}

double needed(const std::vector<CoverPiece>& pieces, const std::vector<uint32_t>& share, const dvec3& c) {
    double radius = 0.0;
    for (uint32_t p : share) {
        radius = std::max(radius, pieces[p].radiusFrom(c));
    }
    return radius;
}

// Pattern search for the centre at which the sphere that contains its part protrudes least.
Sphere fitOne(const Fitting& f, const std::vector<uint32_t>& share, const Sphere& start) {
    dvec3 centre = start.centre;
    double radius = needed(f.pieces, share, centre);
    double best = f.distance.signedDistance(centre) + radius;
    double step = 0.25 * std::max(radius, 1e-9);
    for (int k = 0; k < 60 && step > 1e-3 * radius; ++k) {
        bool better = false;
        for (int way = 0; way < 6 && !better; ++way) {
            dvec3 next = centre;
            next[way / 2] += way % 2 == 0 ? step : -step;
            const double r = needed(f.pieces, share, next);
            if (r - step >= best + radius) { // a step changes the depth by at most its length
                continue;
            }
            const double out = f.distance.signedDistance(next) + r;
            if (out < best - 1e-9 * radius) {
                centre = next;
                radius = r;
                best = out;
                better = true;
            }
        }
        step *= better ? 1.3 : 0.5;
    }
    return {centre, radius};
}

// Assigns each piece to the sphere that would protrude least when it contains the piece.
std::vector<std::vector<uint32_t>> sharesOf(const Fitting& f, const std::vector<Sphere>& spheres) {
    std::vector<std::vector<uint32_t>> shares(spheres.size());
    std::vector<double> depth;
    for (const Sphere& s : spheres) {
        depth.push_back(-f.distance.signedDistance(s.centre));
    }
    for (uint32_t p = 0; p < f.pieces.size(); ++p) {
        size_t chosen = spheres.size();
        double least = 1e300;
        for (size_t i = 0; i < spheres.size(); ++i) {
            const double radius = f.pieces[p].radiusFrom(spheres[i].centre);
            if (radius <= spheres[i].radius * (1.0 + 1e-12) && radius - depth[i] < least) {
                least = radius - depth[i];
                chosen = i;
            }
        }
        if (chosen < spheres.size()) {
            shares[chosen].push_back(p);
        }
    }
    return shares;
}

// Fits every sphere to its part; spheres without a part are removed.
std::vector<Sphere> fitAll(const Fitting& f, const std::vector<Sphere>& spheres) {
    const auto shares = sharesOf(f, spheres);
    std::vector<Sphere> fitted;
    for (size_t i = 0; i < spheres.size(); ++i) {
        if (!shares[i].empty()) {
            Sphere s = fitOne(f, shares[i], spheres[i]);
            s.radius *= 1.0 + 1e-12; // the sphere must contain its part despite rounding
            fitted.push_back(s);
        }
    }
    return fitted;
}

double worst(const Fitting& f, const std::vector<Sphere>& spheres) {
    double most = 0.0;
    for (const Sphere& s : spheres) {
        most = std::max(most, standsOut(f.distance, s));
    }
    return most;
}

// Smallest protrusion for which the greedy cover stays within `leaves`, from above, within `low` .. `high`.
std::vector<Sphere> searchProtrusion(const Fitting& f, uint32_t leaves, double low, double high, int trials) {
    std::vector<Sphere> best;
    for (int k = 0; k < trials; ++k) {
        const double middle = k == 0 && low <= 0.0 ? high : std::sqrt(std::max(low, 1e-4 * high) * high);
        std::vector<Sphere> cover = greedyCover(f.groups, f.seats, middle, leaves);
        if (!cover.empty()) {
            best = std::move(cover);
            high = middle;
        } else {
            low = middle;
        }
    }
    return best;
}

void keepSeats(Fitting& f, const std::vector<Sphere>& spheres) {
    for (const Sphere& s : spheres) {
        f.seats.push_back({s.centre, -f.distance.signedDistance(s.centre)});
    }
}

Sphere fitShare(const Fitting& f, const CoverShare& share) {
    const dvec3 middle = middleOf(f.pieces, share);
    Sphere s = fitOne(f, share, {middle, needed(f.pieces, share, middle)});
    s.radius *= 1.0 + 1e-12;
    return s;
}

std::vector<Sphere> fitShares(const Fitting& f, const std::vector<CoverShare>& shares) {
    std::vector<Sphere> spheres;
    for (const CoverShare& share : shares) {
        spheres.push_back(fitShare(f, share));
    }
    return fitAll(f, spheres);
}

// The best of three starts: greedy for odd shapes, cells of a grid and worst-first halves for regular ones.
std::vector<Sphere> firstCover(const Fitting& f, uint32_t leaves) {
    const double whole = glm::distance(f.mesh.low(), f.mesh.high());
    const auto badness = [&f](const CoverShare& share) {
        const dvec3 middle = middleOf(f.pieces, share);
        return standsOut(f.distance, {middle, needed(f.pieces, share, middle)});
    };
    std::vector<Sphere> best = fitAll(f, searchProtrusion(f, leaves, 0.0, whole, 9));
    for (const auto& shares : {gridShares(f.pieces, leaves), splitShares(f.pieces, leaves, badness)}) {
        std::vector<Sphere> other = fitShares(f, shares);
        if (worst(f, other) < worst(f, best)) {
            best = std::move(other);
        }
    }
    return best;
}

std::vector<Sphere> coverWithin(Fitting& f, uint32_t leaves, uint32_t effort) {
    std::vector<Sphere> best = firstCover(f, leaves);
    for (uint32_t round = 0; round < effort; ++round) {
        const double reached = worst(f, best);
        keepSeats(f, best);
        const auto again = searchProtrusion(f, leaves, 0.75 * reached, reached, 3);
        const std::vector<Sphere> fitted = fitAll(f, again.empty() ? best : again);
        if (worst(f, fitted) < reached) {
            best = fitted;
        }
    }
    return best;
}

Fitting makeFitting(const TriangleMesh& mesh, const MeshDistance& distance, double edge) {
    const dvec3 size = mesh.high() - mesh.low();
    const double cell = std::max(2.0 * edge, std::cbrt(size.x * size.y * size.z / 8000.0));
    std::vector<CoverPiece> pieces = cutToPieces(mesh, distance, edge, cell);
    std::vector<CoverSeat> seats = findSeats(mesh, distance, pieces, kSeats);
    PieceGroups groups(pieces);
    return {mesh, distance, std::move(pieces), std::move(groups), std::move(seats)};
}

} // namespace

Cover coverMesh(const TriangleMesh& mesh, const MeshDistance& distance, const CoverOptions& options) {
    double edge = edgeFor(mesh, kPieces);
    if (options.protrusion > 0.0) {
        edge = std::min(edge, 0.5 * options.protrusion);
        if (countOfPieces(mesh, edge) > kMostPieces) {
            throw Error("a protrusion of " + std::to_string(options.protrusion) +
                        " m is too small for this surface: allow more");
        }
    }
    Fitting f = makeFitting(mesh, distance, edge);
    Cover cover;
    if (options.protrusion > 0.0) {
        cover.spheres = greedyCover(f.groups, f.seats, options.protrusion, kMostCoverSpheres);
        if (cover.spheres.empty()) {
            throw Error("a protrusion of " + std::to_string(options.protrusion) + " m requires more than " +
                        std::to_string(kMostCoverSpheres) + " spheres: allow more");
        }
        cover.spheres = fitAll(f, cover.spheres);
    } else {
        cover.spheres = coverWithin(f, options.leaves, options.effort);
        const double reached = worst(f, cover.spheres);
        const double finer = std::max(0.6 * reached, edgeFor(mesh, 6.0 * kPieces));
        if (finer < 0.7 * edge) { // with many leaves, pieces as large as the spheres would waste them
            Fitting again = makeFitting(mesh, distance, finer);
            f.pieces = std::move(again.pieces);
            f.groups = std::move(again.groups);
            f.seats = std::move(again.seats);
            keepSeats(f, cover.spheres);
            cover.spheres = coverWithin(f, options.leaves, options.effort);
        }
    }
    cover.protrusionBound = worst(f, cover.spheres);
    cover.pieces = f.pieces.size();
    return cover;
}

} // namespace fathom
