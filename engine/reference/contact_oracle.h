// SPDX-License-Identifier: Apache-2.0
// Brute force over every leaf and every region sphere: what the queries, the pair lists and the proxy are
// tested against.
#pragma once

#include "engine/contact/contact_set.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Sources, ascending, of the spheres that the query must return: the float32 test of CullCpu::query on every
// pair.
std::vector<uint32_t> oracleSources(const Tool& tool, const Pose& baseTtool, double reach,
                                    const Fixtures& fixtures);

struct OraclePair {
    uint32_t leaf, source;
    double gap; // [m]
    bool operator<(const OraclePair& other) const {
        return leaf != other.leaf ? leaf < other.leaf : source < other.source;
    }
};

// Every pair with gap <= limit [m] in float64, by leaf and source.
std::vector<OraclePair> oraclePairs(const Tool& tool, const Pose& baseTtool, double limit,
                                    const Fixtures& fixtures);

// Smallest gap over all pairs [m]: below 0 it is the deepest penetration. Infinity without spheres.
double oracleSmallestGap(const Tool& tool, const Pose& baseTtool, const Fixtures& fixtures);

} // namespace fathom
