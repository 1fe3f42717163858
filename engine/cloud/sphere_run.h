// SPDX-License-Identifier: Apache-2.0
// The run of words that a group of spheres.comp packs of its patch's spheres (shaders/lib/packing.glsl).
#pragma once

#include "engine/cloud/sphere_columns.h"

namespace fathom::cloud {

// Takes runs apart, one at a time: what it returns refers to it and to the run. One thread.
class SphereRun {
public:
    explicit SphereRun(bool depths) // false: seen spheres are whole
        : depths_(depths) {}
    // n > 0 spheres; mark: the upper half of `runs`; places as PatchSpheres has them. Without classOf.
    PatchSpheres take(const uint32_t* words, uint32_t n, uint32_t mark, const uint32_t* places) noexcept;

private:
    bool depths_;
    std::array<float, 256> z_;
    std::array<uint8_t, 256> steps_;
};

} // namespace fathom::cloud
