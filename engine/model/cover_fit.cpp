// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_fit.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace fathom {

namespace {

// Radius of the sphere about any centre that contains a part. Pieces in the order of their distance from one
// centre end the search early about others: a radius changes by at most the distance between the centres.
class FarthestPiece {
public:
    FarthestPiece(const std::vector<CoverPiece>& pieces, const CoverShare& share, const dvec3& about)
        : pieces_(pieces)
        , about_(about) {
        for (uint32_t p : share) {
            order_.emplace_back(pieces[p].radiusFrom(about), p);
        }
        std::ranges::sort(order_, std::greater());
    }

    double radius(const dvec3& centre) const {
        const double moved = glm::distance(centre, about_) * (1.0 + 1e-9);
        double farthest = 0.0;
        for (const auto& [first, p] : order_) {
            if (first + moved < farthest) {
                break;
            }
            farthest = std::max(farthest, pieces_[p].radiusFrom(centre));
        }
        return farthest;
    }

private:
    const std::vector<CoverPiece>& pieces_;
    dvec3 about_;
    std::vector<std::pair<double, uint32_t>> order_;
};

// Pattern search for the centre at which the sphere that contains its part protrudes least.
Sphere fitOne(const CoverFitting& f, const CoverShare& share, const Sphere& start) {
    dvec3 centre = start.centre;
    const FarthestPiece farthest(f.pieces, share, centre);
    double radius = farthest.radius(centre), depth = f.distance.signedDistance(centre);
    double best = depth + radius;
    double step = 0.25 * std::max(radius, 1e-9);
    for (int k = 0; k < 60 && step > 1e-3 * radius; ++k) {
        bool better = false;
        for (int way = 0; way < 6 && !better; ++way) {
            dvec3 next = centre;
            next[way / 2] += way % 2 == 0 ? step : -step;
            const double r = farthest.radius(next);
            if (r + depth - step >= best) { // a step changes the depth by at most its length
                continue;
            }
            const double there = f.distance.signedDistance(next, centre, depth);
            if (there + r < best - 1e-9 * radius) {
                centre = next;
                radius = r;
                depth = there;
                best = there + r;
                better = true;
            }
        }
        step *= better ? 1.3 : 0.5;
    }
    return {centre, radius};
}

} // namespace

double radiusAround(const std::vector<CoverPiece>& pieces, const CoverShare& share, const dvec3& c) {
    double radius = 0.0;
    for (uint32_t p : share) {
        radius = std::max(radius, pieces[p].radiusFrom(c));
    }
    return radius;
}

double protrusionOf(const MeshDistance& distance, const Sphere& s) {
    return distance.signedDistance(s.centre) + s.radius;
}

std::vector<CoverShare> sharesOfCover(const CoverFitting& f, const std::vector<Sphere>& spheres) {
    std::vector<CoverShare> shares(spheres.size());
    std::vector<double> depth;
    for (const Sphere& s : spheres) {
        depth.push_back(-f.distance.signedDistance(s.centre));
    }
    for (uint32_t p = 0; p < f.pieces.size(); ++p) {
        size_t chosen = spheres.size();
        double least = 1e300;
        for (size_t i = 0; i < spheres.size(); ++i) {
            const double apart = glm::distance(f.pieces[p].middle, spheres[i].centre); // not over the radius
            if (apart * (1.0 - 1e-12) > spheres[i].radius || apart - depth[i] > least) {
                continue;
            }
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

std::vector<Sphere> fitSpheres(const CoverFitting& f, const std::vector<Sphere>& spheres) {
    const auto shares = sharesOfCover(f, spheres);
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

double worstOf(const CoverFitting& f, const std::vector<Sphere>& spheres) {
    double most = 0.0;
    for (const Sphere& s : spheres) {
        most = std::max(most, protrusionOf(f.distance, s));
    }
    return most;
}

Sphere sphereAround(const CoverFitting& f, const CoverShare& share) {
    const dvec3 middle = middleOf(f.pieces, share);
    Sphere s = fitOne(f, share, {middle, radiusAround(f.pieces, share, middle)});
    s.radius *= 1.0 + 1e-12;
    return s;
}

} // namespace fathom
