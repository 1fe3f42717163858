// SPDX-License-Identifier: Apache-2.0
// A fixture set: everything made from one frame, on the device and on the host.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/contact/fixtures.h"
#include "engine/contact/region_grid.h"
#include "engine/types/lease_pool.h"

namespace fathom::cloud {

// Written by the frame cadence, then read-only while a reader leases it. The host part survives the loss of
// the device.
struct FixtureSet {
    Fixtures host;
    RegionGrid grid;            // over host.spheres
    std::vector<uint32_t> keys; // per sphere: patch * 512 + layer * 256 + slot in the patch, ascending; empty
                                // without a GPU query
    SetBuffers device;

    FixtureSet() = default; // without a device side
    FixtureSet(const gpu::Device& gpu, const Plan& plan, const PatchLayout& layout)
        : device(gpu, plan, layout) {}
};

// Sets are reused when no reader leases them.
using FixturePool = LeasePool<FixtureSet>;

} // namespace fathom::cloud
