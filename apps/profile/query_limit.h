// SPDX-License-Identifier: Apache-2.0
// The device's contact query in the limit study: its minimum work and its measured time.
#pragma once

#include "apps/profile/frame_bench.h"

#include <cstdint>
#include <span>

namespace fathom::profile {

// Lower bounds on the work of shaders/lib/tree_query.glsl for one answer. The shader does more: it also tests
// every sphere against every leaf that its patch can reach, twice if some is in reach.
struct QueryWork {
    double bytes = 0.0, operations = 0.0; // float32 operations, a comparison counts as one
};

// layers: 2 with a layer of held points, otherwise 1. patches: patch of each sphere of the set. found: the
// same for the spheres of the answer. pairs: of the answer.
QueryWork leastQueryWork(const PatchLayout& layout, uint32_t layers, size_t leaves,
                         std::span<const uint32_t> patches, std::span<const uint32_t> found, size_t pairs);

struct QueryLimit {
    QueryWork least;
    Spread time; // [ms] device time; empty without timestamps or without spheres
    size_t leaves = 0, spheres = 0, found = 0;
};

// Measures a ball of 256 leaves in contact with the set of the bench's last run(), at 10 mm reach.
// baseTcamera: camera pose of that frame. The bench's plan must have a tree. Throws Error when the answer
// differs from the CPU's.
QueryLimit measureQuery(const StudyContext& context, const FrameBench& bench, const Pose& baseTcamera);

} // namespace fathom::profile
