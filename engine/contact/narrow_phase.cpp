// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/narrow_phase.h"

#include "engine/contact/pair_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr size_t kChunk = 2048;           // pairs a kernel call: the gaps stay in the first cache
constexpr size_t kMostNear = 4096;        // pairs of one leaf that cones are chosen from at once
constexpr size_t kMostRowsOfLeaf = 8;
constexpr size_t kMostRemembered = 65536; // pairs
constexpr double kCosCone = 0.86602540378443865; // 30 degrees
constexpr double kRounding = 1e-9;        // [m] widens searches by gap at the query
constexpr double kCoincident = 1e-12;     // [m]

PairArrays pairsOf(const ContactSet& set, uint32_t begin, uint32_t end) {
    return {set.pairX.data() + begin, set.pairY.data() + begin, set.pairZ.data() + begin,
            set.pairRadius.data() + begin, end - begin};
}

} // namespace

NarrowPhase::NarrowPhase(const Tool& tool, size_t maxRows)
    : maxRows_(maxRows), rows_(tool.leafCount() * kMostRowsOfLeaf), leaves_(tool.leafCount()),
      lastNormal_(tool.leafCount(), dvec3(0.0)), moved_(tool.leafCount(), 0.0), x_(kMostRemembered),
      y_(kMostRemembered), z_(kMostRemembered), sphereRadius_(kMostRemembered), pair_(kMostRemembered),
      begin_(tool.leafCount() + 1), gaps_(kChunk), near_(kMostNear) {
    for (const Sphere& leaf : tool.leaves()) {
        radius_.push_back(leaf.radius);
    }
}

void NarrowPhase::gather(const ContactSet& set, std::span<const dvec3> leaves, const dvec3& toolCentre,
                         double rowLimit, double checkLimit) noexcept {
    std::copy(leaves.begin(), leaves.end(), leaves_.begin());
    toolCentre_ = toolCentre;
    checkLimit_ = checkLimit;
    rowCount_ = 0;
    remembered_ = 0;
    allRemembered_ = true;
    smallestGap_ = rowLimit;
    for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        begin_[leaf] = static_cast<uint32_t>(remembered_);
        moved_[leaf] = glm::distance(leaves_[leaf], set.leafAtQuery[leaf]);
        if (set.pairBegin[leaf] != set.pairBegin[leaf + 1]) {
            gatherLeaf(set, leaf, rowLimit, checkLimit);
        }
    }
    begin_[leaves_.size()] = static_cast<uint32_t>(remembered_);
    if (rowCount_ > maxRows_) {
        const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(rowCount_);
        std::nth_element(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(maxRows_), end,
                         [](const ContactRow& a, const ContactRow& b) { return a.gap < b.gap; });
        rowCount_ = maxRows_;
    }
}

void NarrowPhase::gatherLeaf(const ContactSet& set, uint32_t leaf, double rowLimit, double checkLimit) noexcept {
    const dvec3& centre = leaves_[leaf];
    const size_t firstRow = rowCount_;
    const uint32_t end = set.pairsUpTo(leaf, rowLimit + moved_[leaf] + kRounding);
    nearCount_ = 0;
    for (uint32_t begin = set.pairBegin[leaf]; begin < end; begin += kChunk) {
        const PairArrays run = pairsOf(set, begin, std::min<uint32_t>(end, begin + kChunk));
        if (pairGaps(run, centre, radius_[leaf], rowLimit, gaps_.data()) == 0) {
            continue;
        }
        for (uint32_t k = 0; k < run.count; ++k) {
            const double gap = gaps_[k];
            if (gap > rowLimit) {
                continue;
            }
            if (gap <= checkLimit) {
                remember(set, begin + k);
            }
            if (nearCount_ == kMostNear) {
                chooseRows(set, leaf, firstRow);
            }
            near_[nearCount_++] = {centre - dvec3(run.x[k], run.y[k], run.z[k]),
                                   gap + (radius_[leaf] + static_cast<double>(run.radius[k])), gap, begin + k};
        }
    }
    chooseRows(set, leaf, firstRow);
    if (rowCount_ == firstRow) {
        return;
    }
    const ContactRow& deepest = *std::min_element(
        rows_.begin() + static_cast<std::ptrdiff_t>(firstRow), rows_.begin() + static_cast<std::ptrdiff_t>(rowCount_),
        [](const ContactRow& a, const ContactRow& b) { return a.gap < b.gap; });
    lastNormal_[leaf] = deepest.normal;
    smallestGap_ = std::min(smallestGap_, deepest.gap);
}

void NarrowPhase::remember(const ContactSet& set, uint32_t pair) noexcept {
    if (remembered_ == kMostRemembered) {
        allRemembered_ = false;
        return;
    }
    x_[remembered_] = set.pairX[pair];
    y_[remembered_] = set.pairY[pair];
    z_[remembered_] = set.pairZ[pair];
    sphereRadius_[remembered_] = set.pairRadius[pair];
    pair_[remembered_++] = pair;
}

// Greedy: the nearest, then the nearest outside its cone, and so on. Takes what is in near_ and empties it.
void NarrowPhase::chooseRows(const ContactSet& set, uint32_t leaf, size_t firstRow) noexcept {
    size_t count = nearCount_;
    nearCount_ = 0;
    const auto dropCone = [&](const ContactRow& row) {
        size_t kept = 0;
        for (size_t k = 0; k < count; ++k) {
            const Near& near = near_[k];
            if (near.gap < row.gap || glm::dot(near.delta, row.normal) < kCosCone * near.distance) {
                near_[kept++] = near;
            }
        }
        count = kept;
    };
    for (size_t r = firstRow; r < rowCount_; ++r) { // chosen from an earlier part of the same leaf
        dropCone(rows_[r]);
    }
    while (count > 0 && rowCount_ < firstRow + kMostRowsOfLeaf) {
        size_t best = 0;
        for (size_t k = 1; k < count; ++k) {
            best = near_[k].gap < near_[best].gap ? k : best;
        }
        rows_[rowCount_] = rowOf(set, leaf, near_[best].delta, near_[best].gap, near_[best].pair);
        near_[best] = near_[--count];
        dropCone(rows_[rowCount_++]);
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

size_t NarrowPhase::check(const ContactSet& set, std::span<const dvec3> next, std::span<const dvec3> exempt,
                          std::span<Violation> out) noexcept {
    size_t count = 0;
    for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        Violation* worst = count < out.size() ? &out[count] : nullptr;
        count += checkLeaf(set, leaf, next[leaf], exempt[leaf], worst) ? 1 : 0;
    }
    return count;
}

bool NarrowPhase::checkLeaf(const ContactSet& set, uint32_t leaf, const dvec3& next, const dvec3& exempt,
                            Violation* worst) noexcept {
    const dvec3& from = leaves_[leaf];
    const double r = radius_[leaf];
    PairArrays all{x_.data() + begin_[leaf], y_.data() + begin_[leaf], z_.data() + begin_[leaf],
                   sphereRadius_.data() + begin_[leaf], begin_[leaf + 1] - begin_[leaf]};
    if (!allRemembered_) {
        all = pairsOf(set, set.pairBegin[leaf], set.pairsUpTo(leaf, checkLimit_ + moved_[leaf] + kRounding));
    }
    double deepest = 0.0;
    size_t deepestAt = 0;
    for (size_t begin = 0; begin < all.count; begin += kChunk) {
        const PairArrays run{all.x + begin, all.y + begin, all.z + begin, all.radius + begin,
                             std::min(kChunk, all.count - begin)};
        size_t left = sweptGaps(run, from, next, r, gaps_.data());
        for (size_t k = 0; left > 0; ++k) {
            if (!(gaps_[k] < 0.0)) {
                continue;
            }
            --left;
            const double depth = std::min(0.0, gapOf(run, k, from, r)) - gaps_[k];
            const dvec3 delta = from - dvec3(run.x[k], run.y[k], run.z[k]);
            if (depth > deepest && !(glm::dot(delta, exempt) < 0.0)) {
                deepest = depth;
                deepestAt = begin + k;
            }
        }
    }
    if (deepest > 0.0 && worst != nullptr) {
        const uint32_t pair =
            allRemembered_ ? pair_[begin_[leaf] + deepestAt] : set.pairBegin[leaf] + static_cast<uint32_t>(deepestAt);
        const dvec3 delta = from - dvec3(set.pairX[pair], set.pairY[pair], set.pairZ[pair]);
        worst->row = rowOf(set, leaf, delta, gapOf(all, deepestAt, from, r), pair);
        worst->depth = deepest;
    }
    return deepest > 0.0;
}

double NarrowPhase::smallestGapAt(const ContactSet& set, std::span<const dvec3> leaves) noexcept {
    double smallest = set.reach;
    // Band 0 of every leaf first: it usually lowers the bound so far that little else need be read.
    for (const bool first : {true, false}) {
        for (uint32_t leaf = 0; leaf < leaves.size(); ++leaf) {
            if (set.pairBegin[leaf] == set.pairBegin[leaf + 1]) {
                continue;
            }
            const double moved = glm::distance(leaves[leaf], set.leafAtQuery[leaf]);
            const uint32_t band0 = set.pairsUpTo(leaf, 0.0);
            const uint32_t end = first ? band0 : set.pairsUpTo(leaf, smallest + moved + kRounding);
            for (uint32_t begin = first ? set.pairBegin[leaf] : band0; begin < end; begin += kChunk) {
                const PairArrays run = pairsOf(set, begin, std::min<uint32_t>(end, begin + kChunk));
                if (pairGaps(run, leaves[leaf], radius_[leaf], smallest, gaps_.data()) != 0) {
                    const auto last = gaps_.begin() + static_cast<std::ptrdiff_t>(run.count);
                    smallest = std::min(smallest, *std::min_element(gaps_.begin(), last));
                }
            }
        }
    }
    return smallest;
}

} // namespace fathom
