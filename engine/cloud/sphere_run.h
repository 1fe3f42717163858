// SPDX-License-Identifier: Apache-2.0
// Decodes the run of words into which the device packs a patch's spheres (shaders/lib/packing.glsl).
#pragma once

#include "engine/cloud/sphere_columns.h"

namespace fathom::cloud {

// Decodes one run at a time. The result refers to this object and to the run. One thread.
class SphereRun {
public:
    explicit SphereRun(bool depths) // false: seen spheres are stored as centre and R
        : depths_(depths) {}
    // n: number of spheres, > 0. mark: upper half of runs[].y. places: as in PatchSpheres. Leaves classOf
    // unset.
    PatchSpheres take(const uint32_t* words, uint32_t n, uint32_t mark, const uint32_t* places) noexcept;

private:
    bool depths_;
    std::array<float, 256> z_;
    std::array<uint8_t, 256> steps_;
};

} // namespace fathom::cloud
