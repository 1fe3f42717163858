// SPDX-License-Identifier: Apache-2.0
// The grid over the host's spheres of a set. Where the device answers contact queries, no set waits for it:
// the first search of the CPU builds it (audit, built-in path, lost device).
#pragma once

#include "engine/contact/region_grid.h"

#include <atomic>
#include <mutex>

namespace fathom::cloud {

class HostGrid {
public:
    // Frame thread, while no reader leases the set. `spheres` must stay unchanged until the next call of
    // either.
    void build(const RegionSpheres& spheres, ThreadPool* workers);
    void buildLater(const RegionSpheres& spheres);

    // Any thread. Builds the grid if no call did; concurrent callers wait for it.
    const RegionGrid& get() const;
    bool built() const { return built_.load(std::memory_order_acquire); }

private:
    mutable std::mutex mutex_; // held while a reader builds
    mutable RegionGrid grid_;
    mutable std::atomic<bool> built_{true};
    const RegionSpheres* spheres_ = nullptr;
};

} // namespace fathom::cloud
