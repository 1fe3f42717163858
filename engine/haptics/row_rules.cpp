// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/row_rules.h"

#include "engine/haptics/proxy_limits.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::proxy {

uint64_t rowKey(ContactRow::Kind kind, uint32_t shape, uint32_t leaf, size_t side) noexcept {
    return (static_cast<uint64_t>(kind) << 60) | (static_cast<uint64_t>(shape) << 40) |
           (static_cast<uint64_t>(leaf) << 8) | side;
}

void flagBehind(const ContactSet& contacts, const LeafCentres& leaves, std::span<dvec3> exempt,
                std::span<double> clearance) noexcept {
    std::fill(exempt.begin(), exempt.end(), dvec3(0.0));
    for (const ContactSet::Behind& flag : contacts.behind) {
        // What the query found left, less what was covered since.
        const dvec3 since = leaves[flag.leaf] - contacts.leafAtQuery[flag.leaf];
        const double left = flag.clearance - glm::dot(since, flag.towardsCamera);
        if (left > 0.0) {
            exempt[flag.leaf] = flag.towardsCamera;
            clearance[flag.leaf] = left;
        }
    }
}

bool equalityAllows(const Shape& shape, const Pose& from, const Pose& to) noexcept {
    std::array<Equality, kMostEqualities> before, after;
    const size_t count = equalitiesOf(shape, from, before);
    equalitiesOf(shape, to, after);
    for (size_t k = 0; k < count; k += 2) { // the length across, then the angle
        const double was = std::hypot(before[k].error, before[k + 1].error);
        if (!(std::hypot(after[k].error, after[k + 1].error) <= std::max(kEqualityRest, was))) {
            return false;
        }
    }
    return true;
}

} // namespace fathom::proxy
