// SPDX-License-Identifier: Apache-2.0
// Brute-force oracles over all leaves and region spheres, for tests of the queries, the pair lists and the
// proxy.
#pragma once

#include "engine/contact/smallest_gap.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Sources of the spheres that the query must return, ascending: those with a gap of at most `reach` (plus 1
// nm) to some leaf, in float64.
std::vector<uint32_t> oracleSources(const Tool& tool, const Pose& baseTtool, double reach,
                                    const HostFixtures& fixtures);

struct OraclePair {
    uint32_t leaf, source;
    double gap; // [m]
    bool operator<(const OraclePair& other) const {
        return leaf != other.leaf ? leaf < other.leaf : source < other.source;
    }
};

// Every pair with gap <= limit [m] in float64, sorted by leaf and source.
std::vector<OraclePair> oraclePairs(const Tool& tool, const Pose& baseTtool, double limit,
                                    const HostFixtures& fixtures);

// Smallest gap over all pairs [m]; a negative gap is the deepest penetration. Infinity without spheres.
double oracleSmallestGap(const Tool& tool, const Pose& baseTtool, const HostFixtures& fixtures);

// The same with its pair, by the definition in smallest_gap.h.
SmallestGap oracleSmallestPair(const Tool& tool, const Pose& baseTtool, const HostFixtures& fixtures);

} // namespace fathom
