// SPDX-License-Identifier: Apache-2.0
// The exact check of the narrow phase: every listed pair, along the whole path, without tolerance.
#include "engine/contact/narrow_phase.h"

#include <algorithm>
#include <cmath>

namespace fathom {

size_t NarrowPhase::check(const ContactSet& set, const LeafCentres& next, std::span<const dvec3> exempt,
                          std::span<Violation> out) noexcept {
    size_t count = 0;
    const auto checkOne = [&](uint32_t leaf, const PairArrays& all, const uint32_t* pairs) {
        Violation* worst = count < out.size() ? &out[count] : nullptr;
        count += checkLeaf(set, leaf, all, pairs, next[leaf], exempt[leaf], worst) ? 1 : 0;
    };
    for (uint32_t run = 0; close_.complete && run < close_.runs; ++run) {
        checkOne(close_.leaf[run], close_.of(run), close_.pair.data() + close_.begin[run]);
    }
    for (uint32_t leaf = 0; !close_.complete && leaf < leaves_.size(); ++leaf) {
        checkOne(leaf, listedUpTo(set, leaf, checkLimit_), nullptr);
    }
    return count;
}

// all: the leaf's pairs that can come near. pairs: their indices; null = consecutive from the leaf's first
// pair.
bool NarrowPhase::checkLeaf(const ContactSet& set, uint32_t leaf, const PairArrays& all,
                            const uint32_t* pairs, const dvec3& next, const dvec3& exempt,
                            Violation* worst) noexcept {
    const dvec3 from = leaves_[leaf];
    const double r = radius_[leaf];
    const bool exempts = exempt != dvec3(0.0);
    double deepest = 0.0;
    size_t deepestAt = 0;
    for (size_t begin = 0; begin < all.count; begin += kPairChunk) {
        const PairArrays run = part(all, begin);
        size_t left = sweptGaps(run, from, next, r, gaps_.data());
        for (size_t k = 0; left > 0; ++k) {
            if (!(gaps_[k] < 0.0)) {
                continue;
            }
            --left;
            const double depth = std::min(0.0, gapOf(run, k, from, r)) - gaps_[k];
            const dvec3 delta = from - dvec3(run.x[k], run.y[k], run.z[k]);
            if (depth > deepest && !(exempts && glm::dot(delta, exempt) < kCosHolds * glm::length(delta))) {
                deepest = depth;
                deepestAt = begin + k;
            }
        }
    }
    if (deepest > 0.0 && worst != nullptr) {
        const uint32_t pair =
            pairs != nullptr ? pairs[deepestAt] : set.pairBegin[leaf] + static_cast<uint32_t>(deepestAt);
        const dvec3 delta = from - dvec3(set.pairX[pair], set.pairY[pair], set.pairZ[pair]);
        worst->row = rowOf(set, leaf, delta, gapOf(all, deepestAt, from, r), pair);
        worst->depth = deepest;
    }
    return deepest > 0.0;
}

double NarrowPhase::smallestGapAt(const ContactSet& set, const LeafCentres& leaves) noexcept {
    double smallest = set.reach;
    // Band 0 of every leaf first: it usually lowers the bound so much that few other pairs are read.
    for (const bool first : {true, false}) {
        for (uint32_t leaf = 0; leaf < leaves.size(); ++leaf) {
            if (set.pairBegin[leaf] == set.pairBegin[leaf + 1]) {
                continue;
            }
            const double moved = glm::distance(leaves[leaf], set.leafAtQuery[leaf]);
            const uint32_t band0 = set.pairsUpTo(leaf, 0.0);
            const uint32_t end = first ? band0 : set.pairsUpTo(leaf, smallest + moved + kPairRounding);
            for (uint32_t begin = first ? set.pairBegin[leaf] : band0; begin < end; begin += kPairChunk) {
                const PairArrays run = pairsOf(set, begin, std::min<uint32_t>(end, begin + kPairChunk));
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
