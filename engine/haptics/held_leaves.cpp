// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/held_leaves.h"

#include <algorithm>

namespace fathom {

bool isOutside(const Shape& shape, const dvec3& centre, double radius, double by) noexcept {
    return shape.keepIn && !shape.isEquality() && gapTo(shape, centre, radius).gap < -by;
}

HeldLeaves::HeldLeaves(size_t leaves, size_t shapes)
    : excluded_(leaves)
    , free_(leaves * shapes)
    , before_(leaves * shapes) {
    placed_.reserve(shapes);
}

void HeldLeaves::choose(std::span<const Shape> shapes, const LeafCentres& centres, const dvec3& origin,
                        std::span<const double> radius, double keeps) noexcept {
    const size_t leaves = excluded_.size(), count = std::min(shapes.size(), placed_.capacity());
    free_.swap(before_);
    for (size_t s = 0; s < count; ++s) {
        const size_t was = indexBefore(shapes[s], s, count);
        for (size_t leaf = 0; leaf < leaves; ++leaf) {
            const bool held = was < placed_.size() && before_[was * leaves + leaf] == 0;
            const bool outside =
                isOutside(shapes[s], centres[leaf] + origin, radius[leaf], held ? keeps : kJustOutside);
            free_[s * leaves + leaf] = outside ? 1 : 0;
        }
    }
    placed_.assign(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(count));
}

// The same shape at the last choice; placed_.size() = none. Rows of fixtures shift when a shape comes or
// goes, so a shape that moved is known by its row only while their number stays.
size_t HeldLeaves::indexBefore(const Shape& shape, size_t index, size_t count) const noexcept {
    const auto equal = [&](const Shape& other) {
        return other.keepIn == shape.keepIn && other.kind == shape.kind && other.size == shape.size &&
               other.baseTshape.position == shape.baseTshape.position &&
               other.baseTshape.rotation == shape.baseTshape.rotation;
    };
    const auto found = std::find_if(placed_.begin(), placed_.end(), equal);
    if (found != placed_.end()) {
        return static_cast<size_t>(found - placed_.begin());
    }
    const bool moved = index < placed_.size() && count == placed_.size() && placed_[index].keepIn &&
                       placed_[index].kind == shape.kind && placed_[index].fixture == shape.fixture;
    return moved ? index : placed_.size();
}

} // namespace fathom
