// SPDX-License-Identifier: Apache-2.0
// Every leaf against every sphere in float64: what the answers of all are compared with.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <vector>

namespace fathom::peers {

constexpr double kTie = 1e-6; // [m] so near the limit that float32 may say either

// For each sphere its smallest d - (reach + r_t + R) over the leaves [m]: within reach when <= 0. Infinity
// without leaves.
std::vector<double> nearbyGaps(const RegionSpheres& spheres, const PosedLeaves& leaves, double reach);

// How an answer differs from the gaps: spheres missing, too many or named twice. What lies within kTie of the
// limit counts apart.
struct Disagreement {
    size_t differ = 0, ties = 0;
};
Disagreement disagreement(const std::vector<double>& gaps, const std::vector<uint32_t>& found);

} // namespace fathom::peers
