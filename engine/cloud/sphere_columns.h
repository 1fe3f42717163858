// SPDX-License-Identifier: Apache-2.0
// Spheres of patches into the columns of a fixture set.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/seen_points.h"
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
    uint32_t seen = 0, held = 0;      // how many; > 0 together
    const uint32_t* places = nullptr; // 8 words a layer: bit (layer * 256 + slot in the patch) = there is one
    uint32_t classes = 0;             // bits of the classes that they are of
    // A slot: class of the sphere | class of the held one << 4; not read if there is one class.
    const uint8_t* classOf = nullptr;
    const float* depths = nullptr;    // of the seen ones [m]; null: they are whole
    const uint8_t* steps = nullptr;   // that these have grown by; null: by none
    const glm::vec4* whole = nullptr; // centre about the origin, R [m]: of the seen ones without depths, then
                                      // of the held ones
    uint32_t n() const { return seen + held; }
};

// Writes the host's columns, which are large enough already. One thread each.
class SphereColumns {
public:
    // rows: row of Scene::fixtures of each class of points. hold: patches have a layer of held points.
    // seen: not null if spheres come as depths.
    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout,
                  const SeenPoints* seen, bool hold);

    // From the columns' place `first` on. Does not allocate.
    void put(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept;
    const SphereCounts& counts() const { return counts_; } // of all that was put

private:
    using Places = std::array<uint16_t, 512 + 8>; // of a patch, layer * 256 + slot; and room to write beyond
    void putCentres(uint32_t patch, size_t first, const PatchSpheres& spheres, const Places& places) noexcept;
    void putClasses(size_t first, const PatchSpheres& spheres, const Places& places) noexcept;

    FixtureSet& set_;
    const SeenPoints* seen_;
    SphereCounts counts_;
    uint32_t words_, across_, width_, pixels_;
    std::array<uint8_t, shared::kMaxClasses> rows_{};
};

} // namespace fathom::cloud
