// SPDX-License-Identifier: Apache-2.0
// Region spheres from the device's readback memory to the host's columns, by patch, then layer (seen, held),
// then slot.
#pragma once

#include "engine/cloud/sphere_columns.h"

namespace fathom {
class ThreadPool;
}

namespace fathom::cloud {

// Fills set.host.spheres and, for a GPU query, set.keys, in parts that several threads may share. rows: row
// of Scene::fixtures of each class of points. Allocates when it is made; taking does not.
class SphereCollector {
public:
    // seen: of the frame's frame; null where the plan packs no depths.
    SphereCollector(FixtureSet& set, const WorkBuffers& work, const SeenPoints* seen, const Plan& plan,
                    const std::vector<uint32_t>& rows, const PatchLayout& layout, ThreadPool& workers);

    uint32_t parts() const { return static_cast<uint32_t>(counts_.size()); }
    void take(uint32_t part) noexcept; // each once, in any order, on any thread
    SphereCounts counts() const;       // when all are taken
    // Nodes with spheres that a tree over the patches has, from the patches up to the root; likewise.
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
    std::vector<uint32_t> begins_;     // of each patch: place of its first sphere; and the end
    std::vector<SphereCounts> counts_; // of each part
};

} // namespace fathom::cloud
