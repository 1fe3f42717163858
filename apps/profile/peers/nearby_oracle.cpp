// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/peers/nearby_oracle.h"

#include <cmath>
#include <limits>

namespace fathom::peers {

std::vector<double> nearbyGaps(const RegionSpheres& s, const PosedLeaves& leaves, double reach) {
    std::vector<double> gaps(s.size(), std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < s.size(); ++i) {
        const dvec3 centre(s.x[i], s.y[i], s.z[i]);
        for (size_t l = 0; l < leaves.x.size(); ++l) {
            const double d = glm::length(centre - dvec3(leaves.x[l], leaves.y[l], leaves.z[l]));
            gaps[i] = std::min(gaps[i], d - (reach + leaves.radius[l] + s.radius[i]));
        }
    }
    return gaps;
}

Disagreement disagreement(const std::vector<double>& gaps, const std::vector<uint32_t>& found) {
    std::vector<uint8_t> named(gaps.size(), 0);
    Disagreement out;
    for (const uint32_t i : found) {
        if (i >= gaps.size() || named[i] != 0) {
            ++out.differ;
        } else {
            named[i] = 1;
        }
    }
    for (size_t i = 0; i < gaps.size(); ++i) {
        if ((named[i] != 0) != (gaps[i] <= 0.0)) {
            ++(std::abs(gaps[i]) <= kTie ? out.ties : out.differ);
        }
    }
    return out;
}

} // namespace fathom::peers
