// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/host_grid.h"

namespace fathom::cloud {

void HostGrid::build(const RegionSpheres& spheres, ThreadPool* workers) {
    grid_.build(spheres, workers);
    spheres_ = &spheres;
    built_.store(true, std::memory_order_release);
}

void HostGrid::buildLater(const RegionSpheres& spheres) {
    built_.store(false, std::memory_order_relaxed); // readers see it with the lease of the set
    spheres_ = &spheres;
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
