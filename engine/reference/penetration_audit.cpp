// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/penetration_audit.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

// Spheres within this distance of a leaf become candidates, tested every tick until the leaf has moved this
// far.
constexpr double kNear = 0.002; // [m]
// Search radius for the nearest sphere of a free leaf [m]. The leaf may move this far before the next search.
constexpr double kFar = 0.02;
// float64 distances of metres are accurate to 1e-15; a search is repeated this much early [m].
constexpr double kAuditRounding = 1e-9;

// The grid skips non-finite spheres, which have no cell.
size_t placedSpheres(const RegionSpheres& spheres) {
    size_t count = 0;
    for (size_t i = 0; i < spheres.size(); ++i) {
        count += std::isfinite(spheres.x[i]) && std::isfinite(spheres.y[i]) && std::isfinite(spheres.z[i]) &&
                 std::isfinite(spheres.radius[i]);
    }
    return count;
}

} // namespace

PenetrationAudit::PenetrationAudit(const Tool& tool) {
    for (const Sphere& sphere : tool.leaves()) {
        Leaf leaf;
        leaf.centre = sphere.centre;
        leaf.radius = sphere.radius;
        leaves_.push_back(std::move(leaf));
    }
    behind_.resize(leaves_.size());
    start_.resize(leaves_.size());
    end_.resize(leaves_.size());
}

void PenetrationAudit::tick(const HostFixtures& set, const RegionGrid& grid, const Pose& start,
                            const Pose& end, std::span<const uint32_t> behind) {
    if (set.frame < 0) {
        return;
    }
    if (!isFinite(start) || !isFinite(end)) {
        throw Error("penetration audit: the tool pose is not finite");
    }
    set_ = &set;
    for (size_t i = 0; i < leaves_.size(); ++i) {
        start_[i] = centreOf(leaves_[i], start);
        end_[i] = centreOf(leaves_[i], end);
    }
    audit(set, grid, behind);
}

void PenetrationAudit::tick(const HostFixtures& set, const RegionGrid& grid, std::span<const dvec3> start,
                            std::span<const dvec3> end, std::span<const uint32_t> behind) {
    if (set.frame < 0) {
        return;
    }
    if (start.size() != leaves_.size() || end.size() != leaves_.size()) {
        throw Error("penetration audit: not as many centres as leaves");
    }
    for (size_t i = 0; i < leaves_.size(); ++i) {
        if (!isFinite(start[i]) || !isFinite(end[i])) {
            throw Error("penetration audit: a leaf's centre is not finite");
        }
        start_[i] = start[i] - set.origin;
        end_[i] = end[i] - set.origin;
    }
    audit(set, grid, behind);
}

void PenetrationAudit::audit(const HostFixtures& set, const RegionGrid& grid,
                             std::span<const uint32_t> behind) {
    set_ = &set;
    grid_ = &grid;
    if (!anySet_ || set.generation != generation_) {
        anySet_ = true;
        generation_ = set.generation;
        placed_ = placedSpheres(set.spheres);
        checkGrid();
        takeAllowances();
    } else {
        checkGrid();
    }
    std::fill(behind_.begin(), behind_.end(), uint8_t{0});
    for (uint32_t leaf : behind) {
        behind_.at(leaf) = 1;
    }
    Worst promised, exempt;
    for (size_t i = 0; i < leaves_.size(); ++i) {
        const Worst worst = judge(leaves_[i], end_[i]);
        Worst& sum = behind_[i] != 0 ? exempt : promised;
        sum.beyond = std::max(sum.beyond, worst.beyond);
        sum.inside = std::max(sum.inside, worst.inside);
        sum.any = std::max(sum.any, worst.any);
        leaves_[i].worst = std::max(leaves_[i].worst, behind_[i] != 0 ? 0.0 : worst.beyond);
    }
    ++ticks_;
    maxPenetration_ = std::max(maxPenetration_, promised.beyond);
    maxEscapeDepth_ = std::max(maxEscapeDepth_, promised.inside);
    maxBehindDepth_ = std::max(maxBehindDepth_, exempt.any);
    penetrationTicks_ += promised.beyond > 0.0;
    escapeTicks_ += promised.inside > 0.0;
    behindTicks_ += exempt.any > 0.0;
    set_ = nullptr;
    grid_ = nullptr;
}

void PenetrationAudit::checkGrid() const {
    if (grid_->size() != placed_) {
        throw Error("penetration audit: the grid has " + std::to_string(grid_->size()) +
                    " spheres, the set " + std::to_string(placed_));
    }
}

// Relative to the set's origin. The origin is subtracted first, so that a far base frame loses no digits.
dvec3 PenetrationAudit::centreOf(const Leaf& leaf, const Pose& pose) const {
    return (pose.position - set_->origin) + pose.rotation * leaf.centre;
}

double PenetrationAudit::gapTo(const Leaf& leaf, const dvec3& centre, uint32_t sphere) const {
    const RegionSpheres& s = set_->spheres;
    const dvec3 region(double{s.x[sphere]}, double{s.y[sphere]}, double{s.z[sphere]});
    return glm::length(centre - region) - leaf.radius - double{s.radius[sphere]};
}

// Finds the candidates at `centre`. A pair keeps its remaining allowance. A pair that is no longer a
// candidate does not touch, so its allowance is 0.
void PenetrationAudit::search(Leaf& leaf, const dvec3& centre) {
    for (const Candidate& candidate : leaf.candidates) {
        allowed_[candidate.sphere] = candidate.allowance;
    }
    before_.swap(leaf.candidates);
    leaf.candidates.clear();
    double nearest = kFar;
    grid_->forEachNear(centre, leaf.radius + grid_->maxRadius() + kFar, [&](uint32_t sphere) {
        const double gap = gapTo(leaf, centre, sphere);
        nearest = std::min(nearest, gap);
        if (gap < kNear) {
            leaf.candidates.push_back({sphere, allowed_[sphere]});
        }
    });
    for (const Candidate& candidate : before_) {
        allowed_[candidate.sphere] = 0.0;
    }
    leaf.searchedAt = centre;
    leaf.mayMove = std::max(nearest, kNear);
}

void PenetrationAudit::takeAllowances() {
    allowed_.assign(set_->spheres.size(), 0.0);
    for (size_t i = 0; i < leaves_.size(); ++i) {
        Leaf& leaf = leaves_[i];
        const dvec3 centre = start_[i];
        leaf.candidates.clear(); // they belong to another set
        search(leaf, centre);
        for (Candidate& candidate : leaf.candidates) {
            candidate.allowance = std::max(0.0, -gapTo(leaf, centre, candidate.sphere));
        }
    }
}

// Compares the depths of one leaf after the tick with its allowances, then shrinks these to the depths.
PenetrationAudit::Worst PenetrationAudit::judge(Leaf& leaf, const dvec3& centre) {
    if (glm::length(centre - leaf.searchedAt) + kAuditRounding >= leaf.mayMove) {
        search(leaf, centre);
    }
    Worst worst;
    for (Candidate& candidate : leaf.candidates) {
        const double depth = std::max(0.0, -gapTo(leaf, centre, candidate.sphere));
        const double inside = std::min(depth, candidate.allowance);
        worst.any = std::max(worst.any, depth);
        worst.beyond = std::max(worst.beyond, depth - candidate.allowance);
        worst.inside = std::max(worst.inside, inside);
        candidate.allowance = inside;
    }
    return worst;
}

} // namespace fathom
