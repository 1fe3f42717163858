// SPDX-License-Identifier: Apache-2.0
// Copies region spheres from the device's readback memory to the host's columns, ordered by patch, layer
// (seen, held) and slot.
#pragma once

#include "engine/cloud/sphere_columns.h"

namespace fathom {
class ThreadPool;
}

namespace fathom::cloud {

// Sources of a frame's spheres.
struct SphereSource {
    const WorkBuffers& work; // classes; radii and points when the plan does not pack
    const SeenPoints* seen;  // points of this frame when the plan packs depths, else null
    const Plan& plan;
    const PatchLayout& layout;
};

// Fills set.host.spheres in parts that several threads may share. fixtures: classFixtures() of the scene.
// Only the constructor allocates.
class SphereCollector {
public:
    SphereCollector(FixtureSet& set, const SphereSource& from, const std::vector<uint32_t>& fixtures,
                    ThreadPool& workers);

    uint32_t parts() const { return static_cast<uint32_t>(counts_.size()); }
    void take(uint32_t part) noexcept; // call once per part, in any order, on any thread
    SphereCounts counts() const;       // after all parts are taken
    // Number of nodes with spheres in a tree over the patches, from the patches up to the root. After all
    // parts are taken.
    uint32_t nodesAbove() const;

private:
    uint32_t placePatches(ThreadPool& workers);
    uint32_t spheresOf(uint32_t patch) const noexcept;
    void takePacked(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept;
    void takeSlots(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept;

    FixtureSet& set_;
    const SphereSource from_;
    const std::vector<uint32_t>& fixtures_;
    std::vector<uint32_t> begins_;     // index of each patch's first sphere, then the end
    std::vector<SphereCounts> counts_; // one per part
};

} // namespace fathom::cloud
