// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/host_grid.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <array>

namespace fathom::cloud {

namespace {

constexpr size_t kRadiusLanes = 16; // of the widest register, each with its own maximum

// Largest radius of the finite spheres; 0 without any.
FATHOM_CLONES
float largestRadius(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                    const float* __restrict radius, size_t count) noexcept {
    std::array<float, kRadiusLanes> most{};
    for (size_t k = 0; k < count; k += kRadiusLanes) {
        const size_t lanes = std::min(kRadiusLanes, count - k);
        for (size_t j = 0; j < lanes; ++j) {
            const size_t i = k + j;
            const float zero = (x[i] - x[i]) + (y[i] - y[i]) + (z[i] - z[i]) + (radius[i] - radius[i]);
            most[j] = zero == 0.0f && radius[i] > most[j] ? radius[i] : most[j];
        }
    }
    return *std::max_element(most.begin(), most.end());
}

} // namespace

void HostGrid::build(const RegionSpheres& spheres, ThreadPool* workers) {
    grid_.build(spheres, workers);
    spheres_ = &spheres;
    maxRadius_ = grid_.maxRadius();
    built_.store(true, std::memory_order_release);
}

void HostGrid::buildLater(const RegionSpheres& spheres) {
    built_.store(false, std::memory_order_relaxed); // readers see it with the lease of the set
    spheres_ = &spheres;
    maxRadius_ = double{largestRadius(spheres.x.data(), spheres.y.data(), spheres.z.data(),
                                      spheres.radius.data(), spheres.size())};
}

const RegionGrid& HostGrid::get() const {
    if (!built()) {
        const std::lock_guard lock(mutex_);
        if (!built_.load(std::memory_order_relaxed)) {
            grid_.build(*spheres_);
            built_.store(true, std::memory_order_release);
        }
    }
    return grid_;
}

} // namespace fathom::cloud
