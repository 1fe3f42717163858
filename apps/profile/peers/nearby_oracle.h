// SPDX-License-Identifier: Apache-2.0
// Tests every leaf against every sphere in float64, as the reference for all answers.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <vector>

namespace fathom::peers {

constexpr double kTie = 1e-6; // [m] this close to the limit, float32 may decide either way

// For each sphere, the smallest d - (reach + r_t + R) over the leaves [m]; within reach if <= 0. Infinity
// without leaves.
std::vector<double> nearbyGaps(const RegionSpheres& spheres, const PosedLeaves& leaves, double reach);

// Counts differences of an answer from the gaps: missing, extra and repeated spheres. Spheres within kTie of
// the limit count as ties.
struct Disagreement {
    size_t differ = 0, ties = 0;
};
Disagreement disagreement(const std::vector<double>& gaps, const std::vector<uint32_t>& found);

} // namespace fathom::peers
