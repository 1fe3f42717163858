// SPDX-License-Identifier: Apache-2.0
// The contact query on the GPU (shaders/lib/tree_query.glsl): tool tree against region tree, in parallel
// (paper V.A).
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/query_answer.h"
#include "engine/cloud/query_run.h"
#include "engine/cloud/sphere_blocks.h"
#include "engine/cloud/tool_leaves.h"
#include "engine/contact/near_pairs.h"
#include "engine/gpu/pipeline.h"

#include <span>
#include <vector>

namespace fathom::cloud {

// Contact thread only. Has a timeline and a command buffer of its own, and a queue of its own where the
// device has a second one.
class TreeQuery {
public:
    // pool: every set of it can be queried. capacity: spheres in the first answer; it grows when an answer
    // does not fit. subgroups: compact the answer by subgroup where the device can.
    TreeQuery(gpu::Device& device, const Plan& plan, const PatchLayout& layout, FixturePool& pool,
              uint32_t capacity = 4096, bool subgroups = true);

    // The leaves of the next queries. The device gets a copy with the next query and keeps it.
    void setTool(const Tool& tool);

    // Lists in `near` every pair of leaf and sphere whose gap is at most `reach` [m], and a few more. Blocks
    // until the device has finished. False when not even the device's largest buffer holds the answer.
    bool list(const FixtureSet& set, const Pose& baseTtool, double reach, NearPairs& near);
    uint32_t capacity() const { return answer_.capacity().spheres; }

    // Asks about pairs at the very limit of the reach, which a device with other arithmetic than Vulkan's
    // would miss. True when it finds them all. shorter: searches a reach that is shorter by this [m]. Drops
    // the tool.
    bool passesProbe(double shorter = 0.0);

    // Enables timestamps, which cost the device a little. gpuMs(): device time of the last query without the
    // copy of its answer; 0 when not enabled or not supported.
    void enableTimestamps() { run_.enableTimestamps(); }
    double gpuMs() const { return run_.gpuMs(); }

private:
    // Blocks that one dispatch searches.
    struct Blocks {
        const gpu::Bindings* bindings;
        uint32_t count, firstBound, layer, layers;
    };
    void makeBindings();
    Blocks frozenBlocks() const;
    shared::QueryParams paramsAt(const Pose& baseTtool, const dvec3& origin, double reach,
                                 double largest) const;
    QueryAnswer::Counts run(std::span<const Blocks> all, const gpu::Device::TimelinePoint& after,
                            const shared::QueryParams& params);
    void record(std::span<const Blocks> all, const shared::QueryParams& params);
    void dispatch(gpu::Commands& commands, const Blocks& blocks, shared::QueryParams params);
    void take(const FixtureSet& set, NearPairs& near) const;

    gpu::Device& device_;
    const PatchLayout layout_;
    FixturePool& pool_;
    bool hold_;
    gpu::Pipeline pipeline_;
    QueryRun run_;

    ToolLeaves leaves_;
    SphereBlocks frozen_; // spheres of frozen classes
    QueryAnswer answer_;
    gpu::Buffer unused_;
    std::vector<gpu::Bindings> bindings_; // one per set
    gpu::Bindings frozenBindings_;
};

} // namespace fathom::cloud
