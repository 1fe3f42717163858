// SPDX-License-Identifier: Apache-2.0
// The image that belongs to a time.
#pragma once

#include <cmath>

namespace fathom {

// The one whose `stamp` [s] is nearest to it, the first of equal ones; null when there are none.
template <class Images>
const typename Images::value_type* nearestStamp(const Images& images, double stamp) noexcept {
    const typename Images::value_type* best = nullptr;
    for (const auto& image : images) {
        if (best == nullptr || std::abs(image.stamp - stamp) < std::abs(best->stamp - stamp)) {
            best = &image;
        }
    }
    return best;
}

} // namespace fathom
