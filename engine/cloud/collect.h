// SPDX-License-Identifier: Apache-2.0
// Brings a finished set from the device's readback memory into plain host memory, in an order that is the
// same for equal frames.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/seen_points.h"
#include "engine/scene/scene.h"
#include "shaders/shared/frame_params.h"

namespace fathom::cloud {

// What a frame counted.
struct FrameCounts {
    uint32_t valid = 0, forbidden = 0;                // pixels, as classify marks them
    std::vector<uint32_t> classPixels;                // a class of points (bit of the mask)
    std::vector<uint32_t> classSpheres, classPatches; // a class: kept spheres, patches with at least one
    uint32_t spheres = 0, patches = 0, nodes = 0;
    std::vector<float> leakSpacing, leakRange; // a class [m]; 0 = none
};

// The frame's depth into host.depth; returns the readings in near..far. Counted on the CPU: a counter that
// 300 000 invocations share costs the device milliseconds. crew: who shares it; null: the caller alone.
uint32_t copyDepth(Fixtures& host, std::span<const uint16_t> depth, const Scene& scene, ThreadPool* workers);

// work: where radii and points are read when the plan packs nothing. seen: of the frame's frame, where it
// packs depths; else null. Fills set.host.spheres, forbiddenBits
// and guidance from the device side; the caller has set camera, pose, origin and frame, and counts the valid
// pixels. crew shares the work. Allocates much only when a frame is larger than any before.
FrameCounts collect(FixtureSet& set, const WorkBuffers& work, const SeenPoints* seen, const Scene& scene,
                    const Plan& plan, const PatchLayout& layout, ThreadPool& workers);

} // namespace fathom::cloud
