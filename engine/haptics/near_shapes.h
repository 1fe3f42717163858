// SPDX-License-Identifier: Apache-2.0
// The leaves that are near placed shapes in one solve, and which of them get rows if not all fit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// One thread. Allocates in the constructor only.
class NearShapes {
public:
    struct Pair { // of a shape and a leaf
        uint16_t shape;
        bool row; // has its rows in the solver
        uint32_t leaf;
        double gap; // [m] of the nearest side
    };

    NearShapes(size_t leaves, size_t shapes);

    void clear() noexcept { pairs_.clear(); }
    // At most leaves x shapes.
    void add(uint32_t shape, uint32_t leaf, double gap) noexcept {
        pairs_.push_back({static_cast<uint16_t>(shape), false, leaf, gap});
    }
    // Chooses at most `room` pairs for rows: the nearest, and of equally near ones an even selection, because
    // leaves of neighbouring numbers are neighbours in space. False when some remain without.
    bool select(size_t room) noexcept;
    std::span<Pair> pairs() noexcept { return pairs_; }
    std::span<const Pair> pairs() const noexcept { return pairs_; }

private:
    static constexpr double kEqual = 1e-6; // [m]

    std::vector<Pair> pairs_;
    std::vector<double> gaps_;
};

} // namespace fathom
