// SPDX-License-Identifier: Apache-2.0
// The listed pairs that the solves of one tick can reach. They are found once per tick, with their gaps. A
// gap changes by at most the displacement of its leaf, so later searches and checks read few of them.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/pair_gaps.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace fathom {

// The listed pairs first .. first + count of one leaf, and what was found out about those that had a gap up
// to the limit of the search: its members.
struct PairRun {
    uint32_t leaf, first, count;
    size_t gaps;                    // where in PairRuns its gaps are
    double members;                 // [m] members are the pairs with a gap up to this
    dvec3 centre{0.0};              // [m] of the leaf when these gaps were computed
    double nearest = 0.0;           // [m] smallest gap
    size_t near = 0, nearCount = 0; // where in PairRuns copies of its nearest pairs are
    // [m] they include every member up to this gap
    double nearUpTo = -std::numeric_limits<double>::infinity();
    dvec3 normal{0.0}; // of the only row that the leaf then had
    // [m] by which the members were inside of that row's cone; < 0: there were several rows
    double room = -1.0;
    double widest = 0.0; // [m] no sphere of the run has a larger radius; unknown while room < 0
};

// Pairs with their sphere values, padded with unreachable spheres so that kernels process whole registers.
struct PairList {
    SphereSpan arrays;
    const uint32_t* pair;
    bool complete; // there are no more than these
};

// One thread. Allocates in the constructor only; everything else is noexcept.
class PairRuns {
public:
    explicit PairRuns(size_t leaves);

    // Begins a search with the leaves at `centres`.
    void clear(const LeafCentres& centres) noexcept;
    // Computes the gaps of pairs `first` to `end` of a leaf and keeps them as a run if one is <= limit.
    // Leaves must come in ascending order. Null: none is, or there is no room; then complete() is false until
    // clear().
    PairRun* add(const ContactSet& set, uint32_t leaf, uint32_t first, uint32_t end, double radius,
                 double limit) noexcept;
    bool complete() const { return complete_; }
    std::span<PairRun> runs() { return {runs_.data(), count_}; }
    const double* gapsOf(const PairRun& run) const { return gaps_.data() + run.gaps; }
    const LeafCentres& centres() const { return centres_; } // at the search

    // Computes the gaps of the members again, for the leaf at `centre`.
    void refresh(const ContactSet& set, PairRun& run, const dvec3& centre, double radius) noexcept;
    // Keeps copies of the members with a gap up to `limit`, if there is room.
    void keepNear(const ContactSet& set, PairRun& run, double limit) noexcept;
    // Members with a gap up to `limit`, in ascending order and perhaps more of them: the copies, or at most
    // kPairChunk from element `from` on, which becomes the element to continue with. Valid until the next
    // call.
    PairList upTo(const ContactSet& set, const PairRun& run, double limit, uint32_t& from) noexcept;

private:
    struct Columns {
        std::vector<float> x, y, z, radius;
        std::vector<uint32_t> pair;

        explicit Columns(size_t capacity);
        SphereSpan arrays(size_t first, size_t count) const {
            return {x.data() + first, y.data() + first, z.data() + first, radius.data() + first, count};
        }
    };
    size_t copy(const ContactSet& set, const PairRun& run, double limit, uint32_t& from, Columns& to,
                size_t at) noexcept;

    LeafCentres centres_;
    std::vector<PairRun> runs_;
    size_t count_ = 0;
    std::vector<double> gaps_;
    size_t gapCount_ = 0;
    bool complete_ = true;
    Columns near_, some_;
    size_t nearCount_ = 0;
    std::vector<uint32_t> chosen_;
};

} // namespace fathom
