// SPDX-License-Identifier: Apache-2.0
// The device's contact query under the study of limits: what it must do at least, and the time that it takes.
#pragma once

#include "apps/profile/frame_bench.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom::profile {

// Lower bounds of shaders/tree_query.comp for one answer; it does more: it also looks at what proves to be
// out of reach, and goes down the tool's tree more than one way.
struct QueryWork {
    double bytes = 0.0, operations = 0.0; // operations are float32, a comparison counts one
};

// keys: FixtureSet::keys; found: indices into them, of the answer, in any order. layers: 2 with a layer of
// held points, else 1. toolLevels: of the tool's tree, its root counted.
QueryWork leastQueryWork(const PatchLayout& layout, uint32_t layers, uint32_t toolLevels,
                         std::span<const uint32_t> keys, std::span<const uint32_t> found);

struct QueryLimit {
    QueryWork least;
    Spread time; // [ms] of the device; empty where it has no timestamps or the set no spheres
    size_t leaves = 0, spheres = 0, found = 0;
};

// A ball of 256 leaves that touches the set of the bench's last run(), at 10 mm reach. baseTcamera: of that
// image. The bench's plan must have a tree. Throws Error where the answer differs from brute force.
QueryLimit measureQuery(const StudyContext& context, const FrameBench& bench, const Pose& baseTcamera);

} // namespace fathom::profile
