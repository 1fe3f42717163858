// SPDX-License-Identifier: Apache-2.0
// Spheres of patches into the columns of a fixture set.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "shaders/shared/frame_params.h"

#include <array>

namespace fathom::cloud {

// How many spheres there are, and in how many patches.
struct SphereCounts {
    uint32_t all = 0, patches = 0;                                         // patches with at least one sphere
    std::array<uint32_t, shared::kMaxClasses> ofClass{}, patchesOfClass{}; // a class of points
};

// The spheres of one patch, by layer (seen, held), then slot.
struct PatchSpheres {
    uint32_t n;               // > 0
    const glm::vec4* spheres; // centre about the origin, R [m]
    const uint32_t* places;   // 8 words a layer: bit (layer * 256 + slot in the patch) = there is one
    uint32_t classes;         // bits of the classes that they are of
    const uint8_t*
        classOf; // a slot: class of the sphere | class of the held one << 4; not read if there is one class
};

// Writes the host's columns, which are large enough already. One thread each.
class SphereColumns {
public:
    // rows: row of Scene::fixtures of each class of points. hold: patches have a layer of held points.
    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout, bool hold);

    // From the columns' place `first` on. Does not allocate.
    void put(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept;
    const SphereCounts& counts() const { return counts_; } // of all that was put

private:
    void putSources(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept;
    void putClasses(uint8_t* fixture, const PatchSpheres& spheres) noexcept;

    FixtureSet& set_;
    SphereCounts counts_;
    uint32_t words_, across_, width_, pixels_;
    std::array<uint8_t, shared::kMaxClasses> rows_{};
};

} // namespace fathom::cloud
