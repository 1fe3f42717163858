// SPDX-License-Identifier: Apache-2.0
// What the queries of a tool against the regions on the GPU share: pipeline, tool, frozen spheres, bindings.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/query_run.h"
#include "engine/cloud/sphere_blocks.h"
#include "engine/cloud/tool_leaves.h"
#include "engine/gpu/pipeline.h"

#include <vector>

namespace fathom::cloud {

// What a query works on. Referenced objects must outlive its users.
struct QueryContext {
    gpu::Device* device; // null only where the plan's queries are the CPU's
    const Plan& plan;
    const PatchLayout& layout;
    FixturePool& pool; // every set of it can be queried
};

// One thread. Has a timeline and a command buffer of its own.
class DeviceQuery {
public:
    // The leaves of the next queries. The device gets a copy with the next query and keeps it.
    void setTool(const Tool& tool);

    // Enables timestamps, which cost the device a little. gpuMs(): device time of the last submission without
    // the copy of its answer; 0 when not enabled or not supported.
    void enableTimestamps() { run_.enableTimestamps(); }
    double gpuMs() const { return run_.gpuMs(); }

protected:
    DeviceQuery(const QueryContext& context, const gpu::PipelineInfo& pipeline);

    // The first buffers of a query's bindings.
    std::vector<const gpu::Buffer*> inputsOf(const SetBuffers& set) const;

    gpu::Device& device_;
    const PatchLayout layout_;
    FixturePool& pool_;
    bool hold_;
    gpu::Pipeline pipeline_;
    QueryRun run_;
    ToolLeaves leaves_;
    SphereBlocks frozen_;                 // spheres of frozen classes
    std::vector<gpu::Bindings> bindings_; // one per set; empty = to be made
};

} // namespace fathom::cloud
