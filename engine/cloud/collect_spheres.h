// SPDX-License-Identifier: Apache-2.0
// Copies region spheres from the device's readback memory to the host's columns, ordered by patch, layer
// (seen, held) and slot.
#pragma once

#include "engine/cloud/sphere_columns.h"

namespace fathom {
class ThreadPool;
}

namespace fathom::cloud {

// Fills set.host.spheres in parts that several threads may share. rows: row of Scene::fixtures for each point
// class. Only the constructor allocates.
class SphereCollector {
public:
    // seen: points of this frame; null if the plan does not pack depths.
    SphereCollector(FixtureSet& set, const WorkBuffers& work, const SeenPoints* seen, const Plan& plan,
                    const std::vector<uint32_t>& rows, const PatchLayout& layout, ThreadPool& workers);

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
    const WorkBuffers& work_;
    const SeenPoints* seen_;
    const Plan& plan_;
    const std::vector<uint32_t>& rows_;
    const PatchLayout& layout_;
    std::vector<uint32_t> begins_;     // index of each patch's first sphere, then the end
    std::vector<SphereCounts> counts_; // one per part
};

} // namespace fathom::cloud
