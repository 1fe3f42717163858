// SPDX-License-Identifier: Apache-2.0
// Where the leaf centres of a tool are, as columns that kernels read.
#pragma once

#include "engine/types/pose.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fathom {

struct LeafCentres {
    std::vector<double> x, y, z; // [m]

    LeafCentres() = default;
    explicit LeafCentres(size_t count)
        : x(count)
        , y(count)
        , z(count) {}
    size_t size() const { return x.size(); }
    dvec3 operator[](size_t i) const { return {x[i], y[i], z[i]}; }
    void set(size_t i, const dvec3& c) { x[i] = c.x, y[i] = c.y, z[i] = c.z; }
    void swap(LeafCentres& other) noexcept { x.swap(other.x), y.swap(other.y), z.swap(other.z); }
    void resize(size_t count) { x.resize(count), y.resize(count), z.resize(count); }
    void reserve(size_t count) { x.reserve(count), y.reserve(count), z.reserve(count); }
    void clear() noexcept { x.clear(), y.clear(), z.clear(); }
};

// Of equally many leaves, about one origin. Straight way of each [m] into `ways`; returns the farthest, 0
// when there is no leaf. A way that is no number is not the farthest.
double straightWays(const LeafCentres& from, const LeafCentres& to, std::span<double> ways) noexcept;

// Farthest of those ways [m].
double leafDisplacement(const LeafCentres& from, const LeafCentres& to) noexcept;

// Whether every one of those ways is at most `limit` [m], but for the rounding of their squares; one that is
// no number is not.
bool waysWithin(const LeafCentres& from, const LeafCentres& to, double limit) noexcept;

} // namespace fathom
