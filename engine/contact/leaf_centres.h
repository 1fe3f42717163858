// SPDX-License-Identifier: Apache-2.0
// Leaf centres of a tool, in columns for vectorised kernels.
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
    void set(size_t i, const dvec3& c) {
        x[i] = c.x;
        y[i] = c.y;
        z[i] = c.z;
    }
    void swap(LeafCentres& other) noexcept {
        x.swap(other.x);
        y.swap(other.y);
        z.swap(other.z);
    }
    void resize(size_t count) {
        x.resize(count);
        y.resize(count);
        z.resize(count);
    }
    void reserve(size_t count) {
        x.reserve(count);
        y.reserve(count);
        z.reserve(count);
    }
    void clear() noexcept {
        x.clear();
        y.clear();
        z.clear();
    }
};

// Displacement of each leaf [m] into `displacements`. Both have the same number of leaves and the same
// origin.
void leafDisplacements(const LeafCentres& from, const LeafCentres& to,
                       std::span<double> displacements) noexcept;

// Largest of these displacements [m], 0 without leaves. NaN is never the largest.
double leafDisplacement(const LeafCentres& from, const LeafCentres& to) noexcept;

// True when every displacement is at most `limit` [m], up to the rounding of its square; false for NaN.
bool leavesWithin(const LeafCentres& from, const LeafCentres& to, double limit) noexcept;

} // namespace fathom
