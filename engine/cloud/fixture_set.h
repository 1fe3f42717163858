// SPDX-License-Identifier: Apache-2.0
// A fixture set: everything made from one frame, on the device and on the host.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/cloud/frozen_classes.h"
#include "engine/cloud/host_grid.h"
#include "engine/contact/behind.h"
#include "engine/contact/host_fixtures.h"
#include "engine/types/lease_pool.h"

namespace fathom::cloud {

// Written by the frame cadence, then read-only while a reader leases it. The host part survives the loss of
// the device.
struct FixtureSet {
    HostFixtures host;
    HostGrid grid; // over host.spheres
    SetBuffers device;
    // For the GPU query.
    std::vector<int> fixtureOfClass;             // index into Scene::fixtures; kFrozen = see below
    std::shared_ptr<const RegionSpheres> frozen; // spheres of frozen classes, about host.origin; null = none
    uint64_t frozenVersion = 0;                  // changes with them; 0 = none so far
    gpu::Device::TimelinePoint completed;        // the passes have written `device`
    double largestRadius = 0.0; // [m] of the finite spheres, those of frozen classes included; 0 = none

    static constexpr int kFrozen = -1; // a frozen class: its spheres in `device` do not count

    // Fills the above. Call after the passes have completed.
    void describeDevice(const Scene& scene, const FrozenClasses& classes,
                        const gpu::Device::TimelinePoint& written);

    // The sphere that a search of the device found. slot: FoundSphere::slot. fixture: index into
    // Scene::fixtures; kFrozen = the sphere does not count.
    struct Place {
        uint32_t source;
        int fixture;
    };
    Place placeOf(const PatchLayout& layout, uint32_t slot, uint32_t pointClass) const;

    PatchBits forbidden(const PatchLayout& layout) const; // in `device`, after the passes have completed

    FixtureSet() = default; // without a device side
    FixtureSet(const gpu::Device& gpu, const Plan& plan, const PatchLayout& layout)
        : device(gpu, plan, layout) {}
};

// Sets are reused when no reader leases them.
using FixturePool = LeasePool<FixtureSet>;

} // namespace fathom::cloud
