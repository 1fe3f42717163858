// SPDX-License-Identifier: Apache-2.0
// Derives the few rows that the solver needs from a contact set and a pose, and checks every listed pair
// exactly.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/contact_set.h"
#include "engine/contact/leaf_centres.h"
#include "engine/contact/pair_gaps.h"
#include "engine/contact/pair_runs.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// One thread; allocates in the constructor only, everything else is noexcept and wait-free.
class NarrowPhase {
public:
    // A pair holds a leaf behind its surface when its normal is more than about 75 degrees from the direction
    // to the camera. The directions of a tool's leaves differ by that much, and a common motion must not
    // deepen the other pairs.
    static constexpr double kCosHolds = 0.25;

    static constexpr double kCone = 0.52359877559829887; // [rad] 30 degrees

    // Only the `maxRows` deepest rows are kept. cone [rad], 0..pi/2: smallest angle between the normals of a
    // leaf's rows. smooth: also make smoothRows().
    NarrowPhase(const Tool& tool, size_t maxRows, double cone = kCone, bool smooth = false);

    // Leaf centres are about set.origin [m], one per leaf of the tool. Finds for each leaf, among listed
    // pairs with gap <= rowLimit, the nearest and the nearest in each further cone of normals: rows().
    // Remembers all pairs with gap <= checkLimit for check(); checkLimit <= rowLimit. anew: false if the set
    // is identical to that of the last call. Then the pairs found before are searched instead of the whole
    // set, until a leaf has moved so far that a pair within checkLimit could be missing. (Rows with a gap
    // above rowLimit minus that motion may be missing.)
    void gather(const ContactSet& set, const LeafCentres& leaves, const dvec3& toolCentre, double rowLimit,
                double checkLimit, bool anew) noexcept;

    // Pairs of this leaf count for nothing from now on: no row, no violation, no smallest gap.
    void exclude(size_t leaf) noexcept { excluded_[leaf] = 1; }

    std::span<const ContactRow> rows() const { return {rows_.data(), rowCount_}; }
    // Planes over the spheres near the leaves that almost touch (smooth_plane.h), for at most kMaxSmooth
    // leaves: one per surface, so up to three in a corner of three walls. `gap` is at most that of the
    // surface's nearest pair and may be negative where that is not; `pair` is that pair. Empty unless asked
    // for at construction, or while a leaf overlaps a sphere.
    std::span<const ContactRow> smoothRows() const {
        return {smoothRows_.data(), smallestGap_ < 0.0 ? 0 : smoothCount_};
    }
    static constexpr size_t kMaxSmooth = 16, kMaxSurfaces = 3;
    // [m] among pairs up to rowLimit; rowLimit when there is none
    double smallestGap() const { return smallestGap_; }

    // A pair that a motion would make too deep: below min(0, its gap at the start) anywhere on the straight
    // path of its leaf.
    struct Violation {
        ContactRow row; // row of the pair at the start of the motion; offset 0
        double depth;   // [m] > 0, excess depth
    };

    // Exact test of every listed pair for leaves that move from their positions at gather() to `next`, none
    // by more than its checkLimit. A nonzero `exempt[leaf]` is the direction to the camera of a leaf behind a
    // surface; pairs that hold it there do not count. Writes the worst violation of each leaf, at most
    // out.size(); returns the number of leaves with violations (may exceed out.size()).
    size_t check(const ContactSet& set, const LeafCentres& next, std::span<const dvec3> exempt,
                 std::span<Violation> out) noexcept;

    // Smallest gap [m] over all listed pairs with the leaves at `leaves`, or set.reach if none is smaller.
    double smallestGapAt(const ContactSet& set, const LeafCentres& leaves) noexcept;

private:
    struct Deepest {        // violation of one leaf
        double depth = 0.0; // [m] 0 = none
        double gap = 0.0;   // [m] at the start
        uint32_t pair = 0;
    };
    bool searchStillServes(double slack) const noexcept;
    void search(const ContactSet& set, double limit) noexcept;
    void searchLeaf(const ContactSet& set, uint32_t leaf, double limit) noexcept;
    void searchAgain(const ContactSet& set, PairRun& run, double limit) noexcept;
    void startRun(const ContactSet& set, PairRun& run, double limit) noexcept;
    bool addOnlyRow(const ContactSet& set, PairRun& run, double limit) noexcept;
    bool addSameRow(const ContactSet& set, const PairRun& run, double limit) noexcept;
    void addRowsOf(const ContactSet& set, const PairRun& run, double limit) noexcept;
    void addRowsOfListed(const ContactSet& set, uint32_t leaf, uint32_t end, double limit) noexcept;
    void finishLeaf(const ContactSet& set, uint32_t leaf, size_t firstRow, const PairRun* run) noexcept;
    Sphere leafAt(uint32_t leaf) const noexcept { return {leaves_[leaf], radius_[leaf]}; }
    // [m] since the gaps of the run were computed
    double travelled(const PairRun& run) const noexcept {
        return glm::distance(leaves_[run.leaf], run.centre);
    }
    uint32_t listedUpTo(const ContactSet& set, uint32_t leaf, double limit) const noexcept;
    void chooseRows(const ContactSet& set, uint32_t leaf, const SphereSpan& run, uint32_t firstPair,
                    const uint32_t* pairs, size_t firstRow, double limit) noexcept;
    void addSmoothRow(const ContactSet& set, const PairRun& run, const ContactRow& nearest) noexcept;
    void agreeOnNormal(const ContactSet& set, uint32_t leaf, size_t firstRow) noexcept;
    ContactRow rowOf(const ContactSet& set, uint32_t leaf, const dvec3& delta, double gap,
                     uint32_t pair) noexcept;
    Deepest deepestOf(const ContactSet& set, const PairRun& run, const dvec3& next,
                      const dvec3& exempt) noexcept;
    Deepest deepestListed(const ContactSet& set, uint32_t leaf, const dvec3& next,
                          const dvec3& exempt) noexcept;
    void deepen(Deepest& deepest, uint32_t leaf, const SphereSpan& run, uint32_t firstPair,
                const uint32_t* pairs, const dvec3& next, const dvec3& exempt) noexcept;

    bool counts(const ContactSet& set, uint32_t leaf) const noexcept { // most leaves have no pairs
        return set.pairBegin[leaf] != set.pairBegin[leaf + 1] && excluded_[leaf] == 0;
    }

    std::vector<double> radius_; // of the leaves
    std::vector<uint8_t> excluded_;
    size_t maxRows_;
    double cosCone_;
    std::vector<ContactRow> rows_;
    size_t rowCount_ = 0;
    std::array<ContactRow, kMaxSmooth * kMaxSurfaces> smoothRows_;
    size_t smoothCount_ = 0, smoothLeaves_ = 0;
    bool smooth_;
    LeafCentres leaves_;            // at the last gather()
    std::vector<dvec3> lastNormal_; // normal of each leaf's deepest row; zero = none yet
    dvec3 toolCentre_{0.0};
    double smallestGap_ = 0.0;
    double checkLimit_ = 0.0;

    PairRuns runs_;                   // of the last search; used by all solves of a tick
    std::vector<double> gaps_, left_; // of one chunk
};

} // namespace fathom
