// SPDX-License-Identifier: Apache-2.0
// The device's contact query in the limit study: its minimum work and its measured time.
#pragma once

#include "apps/profile/frame_bench.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom::profile {

// Lower bounds on the work of shaders/tree_query.comp for one answer. The shader does more: it also tests
// nodes that are out of reach and descends the tool's tree along several paths.
struct QueryWork {
    double bytes = 0.0, operations = 0.0; // float32 operations, a comparison counts as one
};

// keys: FixtureSet::keys. found: the answer as indices into keys, in any order. layers: 2 with a layer of
// held points, otherwise 1. toolLevels: levels of the tool's tree including its root.
QueryWork leastQueryWork(const PatchLayout& layout, uint32_t layers, uint32_t toolLevels,
                         std::span<const uint32_t> keys, std::span<const uint32_t> found);

struct QueryLimit {
    QueryWork least;
    Spread time; // [ms] device time; empty without timestamps or without spheres
    size_t leaves = 0, spheres = 0, found = 0;
};

// Measures a ball of 256 leaves in contact with the set of the bench's last run(), at 10 mm reach.
// baseTcamera: camera pose of that frame. The bench's plan must have a tree. Throws Error when the answer
// differs from brute force.
QueryLimit measureQuery(const StudyContext& context, const FrameBench& bench, const Pose& baseTcamera);

} // namespace fathom::profile
