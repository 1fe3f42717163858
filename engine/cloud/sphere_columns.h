// SPDX-License-Identifier: Apache-2.0
// Writes the spheres of patches to the columns of a fixture set.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/seen_points.h"
#include "shaders/shared/frame_params.h"

#include <array>

namespace fathom::cloud {

// Numbers of spheres, and of patches that have spheres.
struct SphereCounts {
    uint32_t all = 0, patches = 0;                                         // patches with at least one sphere
    std::array<uint32_t, shared::kMaxClasses> ofClass{}, patchesOfClass{}; // per point class
};

// The spheres of one patch, by layer (seen, held), then slot.
struct PatchSpheres {
    uint32_t seen = 0, held = 0; // numbers of spheres; their sum is > 0
    // 8 words per layer: bit (layer * 256 + slot in the patch) = the slot has a sphere.
    const uint32_t* places = nullptr;
    uint32_t classes = 0; // bits of the classes that occur
    // Per slot: class of the seen sphere | class of the held one << 4; not read if there is one class.
    const uint8_t* classOf = nullptr;
    const float* depths = nullptr;  // [m] of the seen spheres; null: all are in `whole`
    const uint8_t* steps = nullptr; // growth steps of the seen spheres; null: none has grown
    // centre relative to the origin, R [m]: of seen spheres without depths, then of held ones
    const glm::vec4* whole = nullptr;
    uint32_t n() const { return seen + held; }
};

// Writes to the host's columns, which must be large enough. One thread per object.
class SphereColumns {
public:
    // fixtures: classFixtures() of the scene. hold: patches have a layer of held points. seen: not
    // null if spheres are given as depths.
    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& fixtures, const PatchLayout& layout,
                  const SeenPoints* seen, bool hold);

    // Writes from index `first` on. Does not allocate.
    void put(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept;
    const SphereCounts& counts() const { return counts_; } // of all put() so far

private:
    using Places = std::array<uint16_t, 512 + 8>; // layer * 256 + slot of a patch's spheres; 8 spare entries
                                                  // because writes come in eights
    void putCentres(uint32_t patch, size_t first, const PatchSpheres& spheres, const Places& places) noexcept;
    void putClasses(size_t first, const PatchSpheres& spheres, const Places& places) noexcept;

    FixtureSet& set_;
    const SeenPoints* seen_;
    SphereCounts counts_;
    uint32_t words_, across_, width_, pixels_;
    std::array<uint8_t, shared::kMaxClasses> fixtures_{};
};

} // namespace fathom::cloud
