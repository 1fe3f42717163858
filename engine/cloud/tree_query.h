// SPDX-License-Identifier: Apache-2.0
// The contact query on the GPU (shaders/tree_query.comp): tool tree against region tree, in parallel (paper
// V.A).
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/contact/tool.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/stopwatch.h"

#include <optional>

namespace fathom::cloud {

// Contact thread only. Has its own timeline and command buffer; shares the queue with the frame cadence.
class TreeQuery {
public:
    // sets: every set of the pool, so that descriptors are created once. capacity: largest number of spheres
    // in an answer.
    TreeQuery(gpu::Device& device, const Plan& plan, const PatchLayout& layout, FixturePool& pool,
              const Tool& tool, uint32_t capacity = 65536);

    // Writes to `found` the index (into set.host.spheres) of every sphere with d^2 <= (reach + r_t + R)^2 for
    // some leaf, in any order. leaves: poseLeaves() at the same pose, relative to the set's origin. Returns
    // false, with `found` invalid, when there are more than the capacity; grow() doubles it. Blocks until the
    // device has finished.
    bool cull(const FixtureSet& set, const PosedLeaves& leaves, const Pose& baseTtool, float reach,
              std::vector<uint32_t>& found);
    void grow();
    uint32_t capacity() const { return capacity_; }

    // Enables timestamps, which cost the device a little. gpuMs(): device time of the last cull; 0 when not
    // enabled or not supported.
    void askForTime() { timed_ = true; }
    double gpuMs() const;

private:
    void makeAnswer();
    void poseTree(const PosedLeaves& leaves, const Pose& baseTtool, const dvec3& origin);
    void record(size_t setIndex);

    gpu::Device& device_;
    const PatchLayout layout_;
    FixturePool& pool_;
    const Tool& tool_;
    bool hold_;
    uint32_t capacity_;
    gpu::Pipeline pipeline_;
    gpu::Timeline timeline_;
    gpu::Commands commands_;
    gpu::Stopwatch watch_;
    bool timed_ = false;
    gpu::Buffer params_, toolTree_, count_, found_, unused_;
    std::vector<gpu::Bindings> bindings_; // one per set
    uint64_t ticket_ = 0;
};

} // namespace fathom::cloud
