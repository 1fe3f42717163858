// SPDX-License-Identifier: Apache-2.0
// Copies a finished set from the device's readback memory to plain host memory. Equal frames give equal
// order.
#pragma once

#include "engine/cloud/collect_spheres.h"
#include "engine/cloud/fixture_set.h"
#include "engine/scene/scene.h"

namespace fathom::cloud {

// Counts of one frame.
struct FrameCounts {
    uint32_t valid = 0, forbidden = 0;                // pixels, as counted by `classify`
    std::vector<uint32_t> classPixels;                // per point class (bit of the mask)
    std::vector<uint32_t> classSpheres, classPatches; // per class: kept spheres; patches with at least one
    uint32_t spheres = 0, patches = 0, nodes = 0;
    std::vector<float> leakSpacing, leakRange; // per class [m]; 0 = none
};

// Copies the frame's depth to host.depth and returns the number of readings in near..far. The CPU counts,
// because a counter shared by 300 000 invocations costs the device milliseconds. workers: null = the caller
// does all the work.
uint32_t copyDepth(HostFixtures& host, std::span<const uint16_t> depth, const Scene& scene,
                   ThreadPool* workers);

// Fills set.host.spheres, forbiddenBits and guidance from the device side, for a plan with passes. The caller
// has set camera, pose, origin and frame, and counts the valid pixels. workers share the work. Allocates
// little, unless a frame is larger than any before.
FrameCounts collect(FixtureSet& set, const Scene& scene, const SphereSource& from, ThreadPool& workers);

} // namespace fathom::cloud
