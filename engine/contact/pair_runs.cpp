// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/pair_runs.h"

#include "engine/contact/query_loop.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr size_t kMaxNear = 65536; // copies
constexpr size_t kLanes = 8;       // the number of copied pairs is a multiple of this
constexpr float kNowhere = 1e18f;  // [m] position of padding; its square is far from overflow

} // namespace

PairRuns::Columns::Columns(size_t capacity)
    : x(capacity)
    , y(capacity)
    , z(capacity)
    , radius(capacity)
    , pair(capacity) {}

PairRuns::PairRuns(size_t leaves)
    : centres_(leaves)
    , runs_(leaves)
    , gaps_(QueryCapacity{}.pairs) // of a contact set, unless a query overflowed
    , near_(kMaxNear)
    , some_(kPairChunk)
    , chosen_(kPairChunk) {}

void PairRuns::clear(const LeafCentres& centres) noexcept {
    centres_ = centres; // same size: does not allocate
    count_ = gapCount_ = nearCount_ = 0;
    complete_ = true;
}

PairRun* PairRuns::add(const ContactSet& set, uint32_t leaf, uint32_t first, uint32_t end, double radius,
                       double limit) noexcept {
    const uint32_t count = end - first;
    complete_ = complete_ && gapCount_ + count <= gaps_.size();
    if (!complete_) {
        return nullptr;
    }
    double* const gaps = gaps_.data() + gapCount_;
    if (pairGaps(pairsOf(set, first, end), {centres_[leaf], radius}, limit, gaps) == 0) {
        return nullptr;
    }
    PairRun& run = runs_[count_++];
    run = {leaf, first, count, gapCount_, limit, centres_[leaf], smallestGapOf(gaps, count)};
    gapCount_ += count;
    return &run;
}

void PairRuns::refresh(const ContactSet& set, PairRun& run, const dvec3& centre, double radius) noexcept {
    double* const gaps = gaps_.data() + run.gaps;
    memberGaps(pairsOf(set, run.first, run.first + run.count), {centre, radius}, run.members, gaps);
    run.members = std::numeric_limits<double>::max(); // others have an infinite gap now
    run.centre = centre;
    run.nearest = smallestGapOf(gaps, run.count);
    run.room = -1.0;
    run.nearUpTo = -std::numeric_limits<double>::infinity();
}

void PairRuns::keepNear(const ContactSet& set, PairRun& run, double limit) noexcept {
    uint32_t from = 0;
    if (nearCount_ + kPairChunk <= kMaxNear) {
        run.near = nearCount_;
        run.nearCount = copy(set, run, limit, from, near_, nearCount_);
        run.nearUpTo = from == run.count ? limit : run.nearUpTo;
        nearCount_ += run.nearCount;
    }
}

PairList PairRuns::upTo(const ContactSet& set, const PairRun& run, double limit, uint32_t& from) noexcept {
    if (from == 0 && limit <= run.nearUpTo) {
        from = run.count;
        return {near_.arrays(run.near, run.nearCount), near_.pair.data() + run.near, true};
    }
    const size_t count = copy(set, run, limit, from, some_, 0);
    return {some_.arrays(0, count), some_.pair.data(), from == run.count};
}

// Copies members with a gap up to `limit`, at most kPairChunk, to `at`; returns their number with padding.
size_t PairRuns::copy(const ContactSet& set, const PairRun& run, double limit, uint32_t& from, Columns& to,
                      size_t at) noexcept {
    const double most = std::min(limit, run.members);
    size_t end = at;
    while (from < run.count && end - at < kPairChunk) {
        const auto window = std::min(run.count - from, static_cast<uint32_t>(kPairChunk - (end - at)));
        const size_t chosen = pairsWithin(gapsOf(run) + from, window, most, chosen_.data());
        for (size_t i = 0; i < chosen; ++i, ++end) {
            const uint32_t pair = run.first + from + chosen_[i];
            to.x[end] = set.pairX[pair];
            to.y[end] = set.pairY[pair];
            to.z[end] = set.pairZ[pair];
            to.radius[end] = set.pairRadius[pair];
            to.pair[end] = pair;
        }
        from += window;
    }
    for (; (end - at) % kLanes != 0; ++end) {
        to.x[end] = to.y[end] = to.z[end] = kNowhere;
        to.radius[end] = 0.0f;
        to.pair[end] = 0;
    }
    return end - at;
}

} // namespace fathom
