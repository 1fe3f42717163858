// SPDX-License-Identifier: Apache-2.0
// From a contact set and a pose to the few rows that the solver needs, and the exact check of every listed
// pair.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/contact_set.h"
#include "engine/contact/leaf_centres.h"
#include "engine/contact/pair_gaps.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// One thread; allocates in the constructor only, everything else is noexcept and wait-free.
class NarrowPhase {
public:
    // A pair holds a leaf behind its surface when its normal makes more than about 75 degrees with the way to
    // the camera: the directions of a tool's leaves
    // differ by as much, and a common motion must not deepen the other pairs.
    static constexpr double kCosHolds = 0.25;

    static constexpr double kCone = 0.52359877559829887; // [rad] 30 degrees

    // Rows are kept to the `maxRows` deepest. cone [rad], 0..pi/2: how far apart the normals of a leaf's rows
    // are at least.
    NarrowPhase(const Tool& tool, size_t maxRows, double cone = kCone);

    // Leaf centres are about set.origin [m], one a leaf of the tool. Finds for each leaf, among listed pairs
    // with gap <= rowLimit, the nearest and the nearest in each further cone of normals: rows().
    // Remembers all pairs with gap
    // <= checkLimit for check(); checkLimit <= rowLimit. anew: false when the set is the one of the last
    // call, bit by bit: pairs found then are searched instead of the whole set, as long as no leaf has
    // moved so far that a pair within checkLimit could be missing (rows beyond rowLimit - that way may be).
    void gather(const ContactSet& set, const LeafCentres& leaves, const dvec3& toolCentre, double rowLimit,
                double checkLimit, bool anew) noexcept;

    std::span<const ContactRow> rows() const { return {rows_.data(), rowCount_}; }
    // Distance of each leaf from where it was at the query [m]; of the last gather().
    std::span<const double> moved() const { return moved_; }
    double farthest() const { return farthest_; } // [m] of moved()
    double smallestGap() const {
        return smallestGap_;
    } // [m] among pairs up to rowLimit; rowLimit when there is none

    // A pair that a motion would take in too deep: below min(0, its gap at the start), anywhere on the
    // straight way of its leaf.
    struct Violation {
        ContactRow row; // of the pair at the start of the motion; offset 0
        double depth;   // [m] > 0, beyond what is allowed
    };

    // Exact test of every listed pair for leaves that go from where gather() saw them to `next`, none farther
    // than its checkLimit. `exempt[leaf]`, when not zero, is the way to the camera of a leaf behind a
    // surface: its pairs that hold it there do not count. Writes the worst of each leaf, at
    // most out.size(); returns how many leaves violate (more than out.size() is possible).
    size_t check(const ContactSet& set, const LeafCentres& next, std::span<const dvec3> exempt,
                 std::span<Violation> out) noexcept;

    // Smallest gap over all listed pairs with the leaves at `leaves` [m]; set.reach when none is nearer.
    double smallestGapAt(const ContactSet& set, const LeafCentres& leaves) noexcept;

private:
    // Pairs with their floats, one run per leaf, of fixed capacity. Most leaves of a tool are far from
    // everything and have no run. begin[0] is 0.
    struct PairList {
        std::vector<float> x, y, z, radius;
        std::vector<uint32_t> pair;
        std::vector<uint32_t> leaf;  // of each run, ascending
        std::vector<uint32_t> begin; // runs + 1
        uint32_t count = 0, runs = 0;
        bool complete = false; // nothing was left out for lack of room

        PairList(size_t leaves, size_t capacity);
        void clear() noexcept;
        PairArrays of(uint32_t run) const {
            return {x.data() + begin[run], y.data() + begin[run], z.data() + begin[run],
                    radius.data() + begin[run], begin[run + 1] - begin[run]};
        }
        // Adds the elements of `run` named by `chosen`; run element k is pair firstPair + k, or pairs[k].
        void add(const PairArrays& run, std::span<const uint32_t> chosen, uint32_t firstPair,
                 const uint32_t* pairs) noexcept;
        // What was added since the last run is the run of this leaf, if anything was: filled up with spheres
        // that nothing reaches, so that kernels see whole registers.
        void endRun(uint32_t ofLeaf) noexcept;
    };
    bool wideStillServes(double slack) const noexcept;
    void findWide(const ContactSet& set, double limit) noexcept;
    void gatherLeaf(const ContactSet& set, uint32_t leaf, const PairArrays& all, const uint32_t* pairs,
                    double rowLimit, double checkLimit) noexcept;
    PairArrays listedUpTo(const ContactSet& set, uint32_t leaf, double limit) const noexcept;
    // Element numbers of `run` with gaps_ <= limit, into chosen_; returns how many.
    size_t choose(size_t count, double limit) noexcept;
    void chooseRows(const ContactSet& set, uint32_t leaf, const PairArrays& run, uint32_t firstPair,
                    const uint32_t* pairs, size_t firstRow, double limit) noexcept;
    void agreeOnNormal(const ContactSet& set, uint32_t leaf, size_t firstRow) noexcept;
    ContactRow rowOf(const ContactSet& set, uint32_t leaf, const dvec3& delta, double gap,
                     uint32_t pair) noexcept;
    bool checkLeaf(const ContactSet& set, uint32_t leaf, const PairArrays& all, const uint32_t* pairs,
                   const dvec3& next, const dvec3& exempt, Violation* worst) noexcept;

    std::vector<double> radius_; // of the leaves
    size_t maxRows_;
    double cosCone_;
    std::vector<ContactRow> rows_;
    size_t rowCount_ = 0;
    LeafCentres leaves_;            // of the last gather()
    LeafCentres wideLeaves_;        // where wide_ was found
    std::vector<dvec3> lastNormal_; // of each leaf's deepest row; zero = none yet
    std::vector<double> moved_;
    double farthest_ = 0.0;
    dvec3 toolCentre_{0.0};
    double smallestGap_ = 0.0;
    double checkLimit_ = 0.0;

    PairList wide_;  // gap <= rowLimit where it was found: serves the solves of a tick
    PairList close_; // gap <= checkLimit at the last gather(): what one step can reach

    std::vector<double> gaps_; // of one chunk
    std::vector<uint32_t> chosen_;
};

} // namespace fathom
