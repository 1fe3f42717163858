// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/near_shapes.h"

#include <algorithm>
#include <cmath>

namespace fathom {

NearShapes::NearShapes(size_t leaves, size_t shapes) {
    pairs_.reserve(leaves * shapes);
    gaps_.reserve(leaves * shapes);
}

bool NearShapes::select(size_t room) noexcept {
    if (pairs_.size() <= room) {
        std::for_each(pairs_.begin(), pairs_.end(), [](Pair& pair) { pair.row = true; });
        return true;
    }
    gaps_.clear();
    for (const Pair& pair : pairs_) {
        gaps_.push_back(pair.gap);
    }
    const auto last = gaps_.begin() + static_cast<std::ptrdiff_t>(room);
    std::nth_element(gaps_.begin(), last, gaps_.end());
    const double limit = *last;
    const auto isNearer = [limit](const Pair& pair) { return pair.gap < limit - kEqual; };
    const auto isEqual = [limit](const Pair& pair) { return std::abs(pair.gap - limit) <= kEqual; };
    const auto nearer = static_cast<size_t>(std::count_if(pairs_.begin(), pairs_.end(), isNearer));
    const auto equal = static_cast<size_t>(std::count_if(pairs_.begin(), pairs_.end(), isEqual));
    size_t seen = 0;
    for (Pair& pair : pairs_) {
        pair.row = isNearer(pair);
        if (isEqual(pair)) { // evenly: (room - nearer) of `equal`
            const size_t left = room - nearer;
            pair.row = (seen + 1) * left / equal > seen * left / equal;
            ++seen;
        }
    }
    return false;
}

} // namespace fathom
