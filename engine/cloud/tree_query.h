// SPDX-License-Identifier: Apache-2.0
// The contact query on the GPU (shaders/lib/tree_query.glsl): tool tree against region tree, in parallel
// (paper V.A).
#pragma once

#include "engine/cloud/device_query.h"
#include "engine/cloud/query_answer.h"
#include "engine/contact/near_pairs.h"

#include <span>

namespace fathom::cloud {

// Contact thread only. Has a queue of its own where the device has a second one.
class TreeQuery : public DeviceQuery {
public:
    // capacity: spheres in the first answer; it grows when an answer does not fit. subgroups: compact the
    // answer by subgroup where the device can.
    explicit TreeQuery(const QueryContext& context, uint32_t capacity = 4096, bool subgroups = true);

    // Lists in `near` every pair of leaf and sphere whose gap is at most `reach` [m], and a few more. Blocks
    // until the device has finished. False when not even the device's largest buffer holds the answer.
    bool list(const FixtureSet& set, const Pose& baseTtool, double reach, NearPairs& near);
    uint32_t capacity() const { return answer_.capacity().spheres; }

    // Asks about pairs at the very limits of reach and bands, which a device with other arithmetic than
    // Vulkan's would miss or get wrong. True when all are right. shorter: searches a reach that is shorter by
    // this [m]. margins: a factor of the margin of the bands. Drops the tool.
    bool passesProbe(double shorter = 0.0, float margins = 1.0f);

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

    QueryAnswer answer_;
    gpu::Buffer unused_;
    gpu::Bindings frozenBindings_;
};

} // namespace fathom::cloud
