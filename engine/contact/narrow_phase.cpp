// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/narrow_phase.h"

#include "engine/contact/pair_gaps.h"
#include "engine/contact/smooth_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr size_t kMostRowsOfLeaf = 8;
constexpr size_t kMostListed = 65536; // pairs per list
constexpr size_t kLanes = 8;          // run lengths are multiples of this
constexpr float kNowhere = 1e18f;     // [m] position of padding; its square is far from overflow
// [m] Closer centres have no direction. Above this the difference of two centres is exact, and only a step
// along it makes no pair deeper on its path.
constexpr double kCoincident = 1e-150;
constexpr uint64_t kSmoothKey = uint64_t{1} << 63; // set in keys of smooth rows only

} // namespace

NarrowPhase::PairList::PairList(size_t leaves, size_t capacity)
    : x(capacity)
    , y(capacity)
    , z(capacity)
    , radius(capacity)
    , pair(capacity)
    , leaf(leaves)
    , begin(leaves + 1) {}

void NarrowPhase::PairList::clear() noexcept {
    count = runs = 0;
    complete = true;
}

void NarrowPhase::PairList::add(const PairArrays& run, std::span<const uint32_t> chosen, uint32_t firstPair,
                                const uint32_t* pairs) noexcept {
    if (count + chosen.size() + kLanes > pair.size()) {
        complete = false;
        return;
    }
    for (const uint32_t k : chosen) {
        x[count] = run.x[k];
        y[count] = run.y[k];
        z[count] = run.z[k];
        radius[count] = run.radius[k];
        pair[count++] = pairs != nullptr ? pairs[k] : firstPair + k;
    }
}

void NarrowPhase::PairList::endRun(uint32_t ofLeaf) noexcept {
    if (count == begin[runs]) {
        return;
    }
    while (complete && count % kLanes != 0) {
        x[count] = y[count] = z[count] = kNowhere;
        radius[count] = 0.0f;
        pair[count++] = 0;
    }
    leaf[runs++] = ofLeaf;
    begin[runs] = count;
}

NarrowPhase::NarrowPhase(const Tool& tool, size_t maxRows, double cone, bool smooth)
    : maxRows_(maxRows)
    , cosCone_(std::cos(cone))
    , rows_(tool.leafCount() * kMostRowsOfLeaf)
    , smooth_(smooth)
    , leaves_(tool.leafCount())
    , wideLeaves_(tool.leafCount())
    , lastNormal_(tool.leafCount(), dvec3(0.0))
    , moved_(tool.leafCount(), 0.0)
    , wide_(tool.leafCount(), kMostListed)
    , close_(tool.leafCount(), kMostListed)
    , gaps_(kPairChunk)
    , chosen_(kPairChunk) {
    for (const Sphere& leaf : tool.leaves()) {
        radius_.push_back(leaf.radius);
    }
}

void NarrowPhase::gather(const ContactSet& set, const LeafCentres& leaves, const dvec3& toolCentre,
                         double rowLimit, double checkLimit, bool anew) noexcept {
    leaves_ = leaves; // same size: does not allocate
    farthest_ = leafDisplacements(set.leafAtQuery, leaves_, moved_);
    toolCentre_ = toolCentre;
    checkLimit_ = checkLimit;
    rowCount_ = smoothCount_ = 0;
    smallestGap_ = rowLimit;
    if (anew || !wideStillServes(rowLimit - checkLimit)) {
        findWide(set, rowLimit);
    }
    close_.clear();
    if (wide_.complete) {
        for (uint32_t run = 0; run < wide_.runs; ++run) {
            gatherLeaf(set, wide_.leaf[run], wide_.of(run), wide_.pair.data() + wide_.begin[run], rowLimit,
                       checkLimit);
        }
    } else {
        for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
            gatherLeaf(set, leaf, listedUpTo(set, leaf, rowLimit), nullptr, rowLimit, checkLimit);
        }
    }
    if (rowCount_ > maxRows_) {
        const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(rowCount_);
        std::nth_element(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(maxRows_), end,
                         [](const ContactRow& a, const ContactRow& b) { return a.gap < b.gap; });
        rowCount_ = maxRows_;
    }
}

// A gap shrinks by at most the leaf's displacement. While that is within the slack, no pair within checkLimit
// is missing.
bool NarrowPhase::wideStillServes(double slack) const noexcept {
    const double most = slack - kPairRounding;
    return wide_.complete && most > 0.0 && leavesWithin(wideLeaves_, leaves_, most);
}

// A superset of the leaf's listed pairs that can have a gap up to `limit` at its present position.
PairArrays NarrowPhase::listedUpTo(const ContactSet& set, uint32_t leaf, double limit) const noexcept {
    return pairsOf(set, set.pairBegin[leaf], set.pairsUpTo(leaf, limit + moved_[leaf] + kPairRounding));
}

void NarrowPhase::findWide(const ContactSet& set, double limit) noexcept {
    wide_.clear();
    wideLeaves_ = leaves_;
    for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        if (set.pairBegin[leaf] == set.pairBegin[leaf + 1]) {
            continue; // most leaves: no band is read
        }
        const uint32_t end = set.pairsUpTo(leaf, limit + moved_[leaf] + kPairRounding);
        for (uint32_t begin = set.pairBegin[leaf]; begin < end; begin += kPairChunk) {
            const PairArrays run = pairsOf(set, begin, std::min<uint32_t>(end, begin + kPairChunk));
            if (pairGaps(run, leaves_[leaf], radius_[leaf], limit, gaps_.data()) != 0) {
                wide_.add(run, {chosen_.data(), choose(run.count, limit)}, begin, nullptr);
            }
        }
        wide_.endRun(leaf);
    }
}

size_t NarrowPhase::choose(size_t count, double limit) noexcept {
    size_t chosen = 0;
    for (size_t k = 0; k < count; ++k) { // branch-free, because hits are unpredictable
        chosen_[chosen] = static_cast<uint32_t>(k);
        chosen += gaps_[k] <= limit ? 1 : 0;
    }
    return chosen;
}

// all: the leaf's pairs that can be within rowLimit. pairs: their indices; null = consecutive from the leaf's
// first pair.
void NarrowPhase::gatherLeaf(const ContactSet& set, uint32_t leaf, const PairArrays& all,
                             const uint32_t* pairs, double rowLimit, double checkLimit) noexcept {
    const dvec3 centre = leaves_[leaf];
    const size_t firstRow = rowCount_;
    for (size_t begin = 0; begin < all.count; begin += kPairChunk) {
        const PairArrays run = part(all, begin);
        if (pairGaps(run, centre, radius_[leaf], rowLimit, gaps_.data()) == 0) {
            continue;
        }
        const uint32_t first = set.pairBegin[leaf] + static_cast<uint32_t>(begin);
        const uint32_t* runPairs = pairs != nullptr ? pairs + begin : nullptr;
        close_.add(run, {chosen_.data(), choose(run.count, checkLimit)}, first, runPairs);
        chooseRows(set, leaf, run, first, runPairs, firstRow, rowLimit);
    }
    close_.endRun(leaf);
    if (rowCount_ == firstRow) {
        return;
    }
    agreeOnNormal(set, leaf, firstRow);
    const ContactRow& deepest =
        *std::min_element(rows_.begin() + static_cast<std::ptrdiff_t>(firstRow),
                          rows_.begin() + static_cast<std::ptrdiff_t>(rowCount_),
                          [](const ContactRow& a, const ContactRow& b) { return a.gap < b.gap; });
    lastNormal_[leaf] = deepest.normal;
    smallestGap_ = std::min(smallestGap_, deepest.gap);
    if (smooth_ && close_.complete && close_.runs > 0 && close_.leaf[close_.runs - 1] == leaf) {
        addSmoothRow(deepest, radius_[leaf] + static_cast<double>(set.pairRadius[deepest.pair]));
    }
}

// From the leaf's run of close pairs, the last one of close_. touch: R + r of the nearest pair [m].
void NarrowPhase::addSmoothRow(const ContactRow& nearest, double touch) noexcept {
    const double depth = std::min(patchDepth(touch), 0.5 * checkLimit_);
    if (smoothCount_ == kMostSmooth || !(nearest.gap >= 0.0) || nearest.gap + depth > checkLimit_) {
        return;
    }
    SmoothPlane plane;
    if (smoothPlane(close_.of(close_.runs - 1), leaves_[nearest.leaf], radius_[nearest.leaf], nearest.gap,
                    depth, chosen_, plane)) {
        ContactRow& row = smoothRows_[smoothCount_++] = nearest;
        row.normal = plane.normal;
        row.gap = plane.gap;
        row.key |= kSmoothKey;
    }
}

// When a sphere's centre coincides with the leaf's, every direction leads out and rowOf() picked an arbitrary
// one. Use the normal of the leaf's deepest other row instead, so that the two rows do not contradict.
void NarrowPhase::agreeOnNormal(const ContactSet& set, uint32_t leaf, size_t firstRow) noexcept {
    const auto anyDirection = [&](const ContactRow& row) {
        return row.gap <= -(radius_[leaf] + static_cast<double>(set.pairRadius[row.pair]));
    };
    size_t guide = rowCount_;
    for (size_t r = firstRow; r < rowCount_; ++r) {
        if (!anyDirection(rows_[r]) && (guide == rowCount_ || rows_[r].gap < rows_[guide].gap)) {
            guide = r;
        }
    }
    for (size_t r = firstRow; r < rowCount_ && guide < rowCount_; ++r) {
        rows_[r].normal = anyDirection(rows_[r]) ? rows_[guide].normal : rows_[r].normal;
    }
}

// Greedy over one run (overwrites gaps_): the nearest pair, then the nearest outside its cone, and so on.
void NarrowPhase::chooseRows(const ContactSet& set, uint32_t leaf, const PairArrays& run, uint32_t firstPair,
                             const uint32_t* pairs, size_t firstRow, double limit) noexcept {
    const dvec3 centre = leaves_[leaf];
    size_t left = run.count;
    for (size_t r = firstRow; r < rowCount_; ++r) { // chosen from an earlier part of the same leaf
        left = dropCone(run, centre, rows_[r].normal, cosCone_, rows_[r].gap, limit, gaps_.data());
    }
    while (left > 0 && rowCount_ < firstRow + kMostRowsOfLeaf) {
        const size_t best = smallestOf(gaps_.data(), run.count);
        if (best == run.count || gaps_[best] > limit) {
            return;
        }
        const dvec3 delta = centre - dvec3(run.x[best], run.y[best], run.z[best]);
        const uint32_t pair = pairs != nullptr ? pairs[best] : firstPair + static_cast<uint32_t>(best);
        const ContactRow& row = rows_[rowCount_++] = rowOf(set, leaf, delta, gaps_[best], pair);
        gaps_[best] = std::numeric_limits<double>::infinity(); // also when it has no direction
        left = dropCone(run, centre, row.normal, cosCone_, row.gap, limit, gaps_.data());
    }
}

ContactRow NarrowPhase::rowOf(const ContactSet& set, uint32_t leaf, const dvec3& delta, double gap,
                              uint32_t pair) noexcept {
    ContactRow row;
    const double length = glm::length(delta);
    if (length > kCoincident) {
        row.normal = delta / length;
    } else if (lastNormal_[leaf] != dvec3(0.0)) {
        row.normal = lastNormal_[leaf];
    } else {
        const dvec3 toCamera = set.camera - leaves_[leaf];
        const double far = glm::length(toCamera);
        row.normal = far > kCoincident ? toCamera / far : dvec3(0.0, 0.0, 1.0);
    }
    row.arm = leaves_[leaf] - toolCentre_;
    row.gap = gap;
    row.leaf = leaf;
    row.pair = pair;
    row.kind = ContactRow::Kind::Sphere;
    row.key = (static_cast<uint64_t>(leaf) << 32) | set.source[set.pairSphere[pair]];
    return row;
}

} // namespace fathom
