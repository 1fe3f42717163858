// SPDX-License-Identifier: Apache-2.0
// Where the leaf centres of a tool are, as columns that kernels read.
#pragma once

#include "engine/types/pose.h"

#include <cstddef>
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
};

} // namespace fathom
