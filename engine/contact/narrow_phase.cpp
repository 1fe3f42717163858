// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/narrow_phase.h"

#include "engine/contact/smooth_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr size_t kMaxRowsOfLeaf = 8;
// [m] Closer centres have no direction. Above this the difference of two centres is exact, and only a step
// along it makes no pair deeper on its path.
constexpr double kCoincident = 1e-150;
constexpr double kStale = 5e-5; // [m] when a leaf has moved farther, its gaps are computed again
constexpr uint64_t kSmoothKey = uint64_t{1} << 63; // set in keys of smooth rows only

} // namespace

NarrowPhase::NarrowPhase(const Tool& tool, size_t maxRows, double cone, bool smooth)
    : excluded_(tool.leafCount())
    , maxRows_(maxRows)
    , cosCone_(std::cos(cone))
    , rows_(tool.leafCount() * kMaxRowsOfLeaf)
    , smooth_(smooth)
    , leaves_(tool.leafCount())
    , lastNormal_(tool.leafCount(), dvec3(0.0))
    , runs_(tool.leafCount())
    , gaps_(kPairChunk)
    , left_(kPairChunk) {
    for (const Sphere& leaf : tool.leaves()) {
        radius_.push_back(leaf.radius);
    }
}

void NarrowPhase::gather(const ContactSet& set, const LeafCentres& leaves, const dvec3& toolCentre,
                         double rowLimit, double checkLimit, bool anew) noexcept {
    leaves_ = leaves; // same size: does not allocate
    toolCentre_ = toolCentre;
    checkLimit_ = checkLimit;
    rowCount_ = smoothCount_ = smoothLeaves_ = 0;
    smallestGap_ = rowLimit;
    if (anew || !searchStillServes(rowLimit - checkLimit)) {
        search(set, rowLimit);
    } else {
        for (PairRun& run : runs_.runs()) {
            searchAgain(set, run, rowLimit);
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
bool NarrowPhase::searchStillServes(double slack) const noexcept {
    const double most = slack - kPairRounding;
    return runs_.complete() && most > 0.0 && leavesWithin(runs_.centres(), leaves_, most);
}

// End of the leaf's listed pairs that can have a gap up to `limit` at its present position.
uint32_t NarrowPhase::listedUpTo(const ContactSet& set, uint32_t leaf, double limit) const noexcept {
    const double moved = glm::distance(set.leafAtQuery[leaf], leaves_[leaf]);
    return set.pairsUpTo(leaf, limit + moved + kPairRounding);
}

void NarrowPhase::search(const ContactSet& set, double limit) noexcept {
    runs_.clear(leaves_);
    for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        if (counts(set, leaf)) { // else no band is read
            searchLeaf(set, leaf, limit);
        }
    }
}

void NarrowPhase::searchLeaf(const ContactSet& set, uint32_t leaf, double limit) noexcept {
    const size_t firstRow = rowCount_;
    const uint32_t end = listedUpTo(set, leaf, limit);
    PairRun* const run = runs_.add(set, leaf, set.pairBegin[leaf], end, radius_[leaf], limit);
    if (!runs_.complete()) {
        addRowsOfListed(set, leaf, end, limit);
    } else if (run != nullptr) {
        startRun(set, *run, limit);
    }
    finishLeaf(set, leaf, firstRow, run);
}

void NarrowPhase::searchAgain(const ContactSet& set, PairRun& run, double limit) noexcept {
    const size_t firstRow = rowCount_;
    if (travelled(run) > kStale) {
        runs_.refresh(set, run, leaves_[run.leaf], radius_[run.leaf]);
        startRun(set, run, limit);
    } else if (!addSameRow(set, run, limit)) {
        addRowsOf(set, run, limit);
    }
    finishLeaf(set, run.leaf, firstRow, &run);
}

// Rows of a run whose gaps are those of the present positions.
void NarrowPhase::startRun(const ContactSet& set, PairRun& run, double limit) noexcept {
    // Enough for the smooth planes, and for most checks, until the leaf has moved by kStale.
    const double touch = radius_[run.leaf] + static_cast<double>(set.pairRadius[run.first]);
    const double depth = smooth_ ? std::min(patchDepth(touch), 0.5 * checkLimit_) : 0.0;
    runs_.keepNear(set, run, run.nearest + depth + 2.0 * kStale + kPairRounding);
    if (!addOnlyRow(set, run, limit)) {
        addRowsOf(set, run, limit);
    }
}

// True when one row represents all pairs of the run, or there is none.
bool NarrowPhase::addOnlyRow(const ContactSet& set, PairRun& run, double limit) noexcept {
    if (run.count > kPairChunk || !(run.nearest <= limit)) {
        return !(run.nearest <= limit);
    }
    const dvec3 centre = leaves_[run.leaf];
    const double* const gaps = runs_.gapsOf(run);
    const SphereSpan all = pairsOf(set, run.first, run.first + run.count);
    const auto nearest = static_cast<uint32_t>(indexOfGap(gaps, run.count, run.nearest));
    const ContactRow row =
        rowOf(set, run.leaf, awayFrom(all, nearest, centre), run.nearest, run.first + nearest);
    const ConeRoom room =
        roomInCone(all, {centre, radius_[run.leaf]}, row.normal, cosCone_, run.members, gaps, left_.data());
    if (!(room.least > kPairRounding)) {
        return false;
    }
    run.normal = row.normal;
    run.room = room.least;
    run.widest = room.widest;
    rows_[rowCount_++] = row;
    return true;
}

// True when the run still has one row or none, because the cone of its row has room for all that the leaf's
// motion since can have changed.
bool NarrowPhase::addSameRow(const ContactSet& set, const PairRun& run, double limit) noexcept {
    const double since = travelled(run), r = radius_[run.leaf];
    const double most = run.nearest + 2.0 * since + kPairRounding;
    if (run.room < 0.0 || most > run.nearUpTo) {
        return false;
    }
    const dvec3 centre = leaves_[run.leaf];
    uint32_t from = 0;
    const PairList near = runs_.upTo(set, run, most, from);
    pairGaps(near.arrays, {centre, r}, limit, gaps_.data());
    const double least = smallestGapOf(gaps_.data(), near.arrays.count);
    if (!(least <= limit)) {
        return true; // no row any more
    }
    const size_t nearest = indexOfGap(gaps_.data(), near.arrays.count, least);
    const ContactRow row =
        rowOf(set, run.leaf, awayFrom(near.arrays, nearest, centre), least, near.pair[nearest]);
    // A direction d to a sphere changes by `since`, and d . normal by that and |d| times the change of the
    // normal.
    const double longest =
        2.0 * limit + r + run.widest; // the leaf moved by less than `limit` since the search
    if (!(run.room > glm::distance(row.normal, run.normal) * longest + 2.0 * since + kPairRounding)) {
        return false;
    }
    rows_[rowCount_++] = row;
    return true;
}

// The nearest of the members, and the nearest in each further cone.
void NarrowPhase::addRowsOf(const ContactSet& set, const PairRun& run, double limit) noexcept {
    const size_t firstRow = rowCount_;
    for (uint32_t from = 0; from < run.count;) {
        const PairList part = runs_.upTo(set, run, run.members, from);
        if (pairGaps(part.arrays, leafAt(run.leaf), limit, gaps_.data()) != 0) {
            chooseRows(set, run.leaf, part.arrays, 0, part.pair, firstRow, limit);
        }
    }
}

// Among the listed pairs of the leaf before `end`, which were not kept.
void NarrowPhase::addRowsOfListed(const ContactSet& set, uint32_t leaf, uint32_t end, double limit) noexcept {
    const size_t firstRow = rowCount_;
    for (uint32_t begin = set.pairBegin[leaf]; begin < end; begin += kPairChunk) {
        const SphereSpan part = pairsOf(set, begin, std::min<uint32_t>(end, begin + kPairChunk));
        if (pairGaps(part, leafAt(leaf), limit, gaps_.data()) != 0) {
            chooseRows(set, leaf, part, begin, nullptr, firstRow, limit);
        }
    }
}

// run: null when the leaf has none.
void NarrowPhase::finishLeaf(const ContactSet& set, uint32_t leaf, size_t firstRow,
                             const PairRun* run) noexcept {
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
    if (smooth_ && run != nullptr && deepest.gap >= 0.0 && smoothLeaves_ < kMaxSmooth) {
        const size_t before = smoothCount_;
        for (size_t r = firstRow; r < rowCount_ && smoothCount_ < before + kMaxSurfaces; ++r) {
            addSmoothRow(set, *run, rows_[r]);
        }
        smoothLeaves_ += smoothCount_ > before ? 1 : 0;
    }
}

// A plane over the surface that this row's sphere is the nearest of, if it is.
void NarrowPhase::addSmoothRow(const ContactSet& set, const PairRun& run,
                               const ContactRow& nearest) noexcept {
    const double touch = radius_[run.leaf] + static_cast<double>(set.pairRadius[nearest.pair]);
    const double depth = std::min(patchDepth(touch), 0.5 * checkLimit_);
    if (nearest.gap + depth > checkLimit_) {
        return;
    }
    uint32_t from = 0;
    const PairList near = runs_.upTo(set, run, nearest.gap + depth + travelled(run) + kPairRounding, from);
    SmoothPlane plane;
    if (near.complete &&
        smoothPlane(near.arrays, leafAt(run.leaf), {nearest.normal, nearest.gap}, depth, plane)) {
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

// Greedy over one run with gaps_ (overwrites them): the nearest pair, then the nearest outside its cone, and
// so on. pairs: the pairs of its elements; null = consecutive from firstPair.
void NarrowPhase::chooseRows(const ContactSet& set, uint32_t leaf, const SphereSpan& run, uint32_t firstPair,
                             const uint32_t* pairs, size_t firstRow, double limit) noexcept {
    const dvec3 centre = leaves_[leaf];
    size_t left = run.count;
    for (size_t r = firstRow; r < rowCount_; ++r) { // chosen from an earlier part of the same leaf
        left = dropCone(run, centre, rows_[r].normal, cosCone_, rows_[r].gap, limit, gaps_.data());
    }
    while (left > 0 && rowCount_ < firstRow + kMaxRowsOfLeaf) {
        const double least = smallestGapOf(gaps_.data(), run.count);
        if (!(least <= limit)) {
            return;
        }
        const size_t best = indexOfGap(gaps_.data(), run.count, least);
        const uint32_t pair = pairs != nullptr ? pairs[best] : firstPair + static_cast<uint32_t>(best);
        const ContactRow& row = rows_[rowCount_++] =
            rowOf(set, leaf, awayFrom(run, best, centre), least, pair);
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
