// SPDX-License-Identifier: Apache-2.0
// The exact check of the narrow phase: every listed pair, along the whole path, without tolerance.
#include "engine/contact/narrow_phase.h"

#include <algorithm>

namespace fathom {

size_t NarrowPhase::check(const ContactSet& set, const LeafCentres& next, std::span<const dvec3> exempt,
                          std::span<Violation> out) noexcept {
    size_t count = 0;
    const auto report = [&](uint32_t leaf, const Deepest& deepest) {
        if (deepest.depth > 0.0 && count++ < out.size()) {
            const uint32_t pair = deepest.pair;
            const dvec3 delta = leaves_[leaf] - dvec3(set.pairX[pair], set.pairY[pair], set.pairZ[pair]);
            out[count - 1] = {rowOf(set, leaf, delta, deepest.gap, pair), deepest.depth};
        }
    };
    if (runs_.complete()) {
        for (const PairRun& run : runs_.runs()) {
            report(run.leaf, deepestOf(set, run, next[run.leaf], exempt[run.leaf]));
        }
        return count;
    }
    for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        if (counts(set, leaf)) {
            report(leaf, deepestListed(set, leaf, next[leaf], exempt[leaf]));
        }
    }
    return count;
}

// Reads the pairs whose gap was at most what the leaf travels from where it was then to `next`.
NarrowPhase::Deepest NarrowPhase::deepestOf(const ContactSet& set, const PairRun& run, const dvec3& next,
                                            const dvec3& exempt) noexcept {
    Deepest deepest;
    const double within = travelled(run) + glm::distance(leaves_[run.leaf], next) + kPairRounding;
    for (uint32_t from = run.nearest <= within ? 0 : run.count; from < run.count;) {
        const PairList part = runs_.upTo(set, run, within, from);
        deepen(deepest, run.leaf, part.arrays, 0, part.pair, next, exempt);
    }
    return deepest;
}

NarrowPhase::Deepest NarrowPhase::deepestListed(const ContactSet& set, uint32_t leaf, const dvec3& next,
                                                const dvec3& exempt) noexcept {
    Deepest deepest;
    const uint32_t end = listedUpTo(set, leaf, checkLimit_);
    for (uint32_t begin = set.pairBegin[leaf]; begin < end; begin += kPairChunk) {
        const SphereSpan part = pairsOf(set, begin, std::min<uint32_t>(end, begin + kPairChunk));
        deepen(deepest, leaf, part, begin, nullptr, next, exempt);
    }
    return deepest;
}

// Keeps the deepest violation of the leaf. pairs: the pairs of the run's elements; null = consecutive from
// firstPair.
void NarrowPhase::deepen(Deepest& deepest, uint32_t leaf, const SphereSpan& run, uint32_t firstPair,
                         const uint32_t* pairs, const dvec3& next, const dvec3& exempt) noexcept {
    const dvec3 from = leaves_[leaf];
    const bool exempts = exempt != dvec3(0.0);
    size_t left = sweptGaps(run, from, next, radius_[leaf], gaps_.data());
    for (size_t k = 0; left > 0; ++k) {
        if (!(gaps_[k] < 0.0)) {
            continue;
        }
        --left;
        const double gap = gapOf(run, k, {from, radius_[leaf]}), depth = std::min(0.0, gap) - gaps_[k];
        const dvec3 delta = awayFrom(run, k, from);
        if (depth > deepest.depth && !(exempts && glm::dot(delta, exempt) < kCosHolds * glm::length(delta))) {
            deepest = {depth, gap, pairs != nullptr ? pairs[k] : firstPair + static_cast<uint32_t>(k)};
        }
    }
}

double NarrowPhase::smallestGapAt(const ContactSet& set, const LeafCentres& leaves) noexcept {
    double smallest = set.reach;
    // Band 0 of every leaf first: it usually lowers the bound so much that few other pairs are read.
    for (const bool first : {true, false}) {
        for (uint32_t leaf = 0; leaf < leaves.size(); ++leaf) {
            if (!counts(set, leaf)) {
                continue;
            }
            const double moved = glm::distance(leaves[leaf], set.leafAtQuery[leaf]);
            const uint32_t band0 = set.pairsUpTo(leaf, 0.0);
            const uint32_t end = first ? band0 : set.pairsUpTo(leaf, smallest + moved + kPairRounding);
            for (uint32_t begin = first ? set.pairBegin[leaf] : band0; begin < end; begin += kPairChunk) {
                const SphereSpan run = pairsOf(set, begin, std::min<uint32_t>(end, begin + kPairChunk));
                if (pairGaps(run, {leaves[leaf], radius_[leaf]}, smallest, gaps_.data()) != 0) {
                    smallest = std::min(smallest, smallestGapOf(gaps_.data(), run.count));
                }
            }
        }
    }
    return smallest;
}

} // namespace fathom
