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
    void leaveOut(size_t leaf) noexcept { leftOut_[leaf] = 1; }
    bool leftOut(size_t leaf) const noexcept { return leftOut_[leaf] != 0; }
    // Until choose(), every shape holds every leaf that is not left out.
    bool holds(size_t shape, size_t leaf) const noexcept {
        return leftOut_[leaf] == 0 && free_[shape * leftOut_.size() + leaf] == 0;
    }
    // Chooses for each keep_in shape: the leaves that are inside, and those that it held at the last choice.
    // centres: about `origin` [m], base frame.
    void choose(std::span<const Shape> shapes, const LeafCentres& centres, const dvec3& origin,
                std::span<const double> radius) noexcept;
    // The next choice is by where the leaves are alone: the arm was somewhere else.
    void forget() noexcept { placed_.clear(); }

private:
    size_t indexBefore(const Shape& shape, size_t index, size_t count) const noexcept;

    std::vector<uint8_t> leftOut_;       // per leaf
    std::vector<uint8_t> free_, before_; // per shape and leaf: outside of a keep_in shape
    std::vector<Shape> placed_;          // at the last choice
};

// Whether a keep_in shape does not hold a leaf that is there when the shape is placed. Centre in the base
// frame [m], radius [m].
bool isOutside(const Shape& shape, const dvec3& centre, double radius) noexcept;

} // namespace fathom
