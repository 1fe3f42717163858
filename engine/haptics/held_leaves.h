// SPDX-License-Identifier: Apache-2.0
// Which leaves the placed shapes and the regions hold. A free tool's are all held. Of an arm, those that no
// joint moves are not. A keep_in shape holds only those that were inside when it was placed: a box around the
// tool would otherwise pull in the base.
#pragma once

#include "engine/contact/leaf_centres.h"
#include "engine/contact/shapes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// One thread. Allocates in the constructor only; everything else is noexcept.
class HeldLeaves {
public:
    HeldLeaves(size_t leaves, size_t shapes);

    // Nothing moves this leaf, so nothing holds it.
    void exclude(size_t leaf) noexcept { excluded_[leaf] = 1; }
    bool excluded(size_t leaf) const noexcept { return excluded_[leaf] != 0; }
    // Until choose(), every shape holds every leaf that is not excluded.
    bool holds(size_t shape, size_t leaf) const noexcept {
        return excluded_[leaf] == 0 && free_[shape * excluded_.size() + leaf] == 0;
    }
    // Chooses for each keep_in shape: the leaves that are inside, and those that it held at the last choice
    // and that are now at most `keeps` [m] outside. centres: about `origin` [m], base frame.
    void choose(std::span<const Shape> shapes, const LeafCentres& centres, const dvec3& origin,
                std::span<const double> radius, double keeps) noexcept;

private:
    size_t indexBefore(const Shape& shape, size_t index, size_t count) const noexcept;

    std::vector<uint8_t> excluded_;      // per leaf
    std::vector<uint8_t> free_, before_; // per shape and leaf: outside of a keep_in shape
    std::vector<Shape> placed_;          // at the last choice
};

inline constexpr double kJustOutside = 1e-6; // [m] smaller depths are rounding

// Whether a leaf is more than `by` [m] outside of a keep_in shape, which does not hold a leaf that is outside
// when the shape is placed. Centre in the base frame [m], radius [m].
bool isOutside(const Shape& shape, const dvec3& centre, double radius, double by = kJustOutside) noexcept;

} // namespace fathom
