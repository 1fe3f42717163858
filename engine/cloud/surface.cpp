// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/surface.h"

#include "shaders/shared/frame_params.h"
#include "shaders/surface.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

namespace {

// A row of four pixels an invocation: 64 do a patch.
uint32_t groupOf(const Plan& plan) {
    return plan.filterRow ? std::min(64u, plan.pixelGroup) : plan.pixelGroup;
}

bool inPairs(const CloudContext& c) {
    return c.plan.filterRow && c.camera.depth.width % 2 == 0;
}

} // namespace

SurfacePass::SurfacePass(const CloudContext& c)
    : pipeline_(c.device, {"surface",
                           surface_spv,
                           6,
                           true,
                           0,
                           std::array{groupOf(c.plan), uint32_t{c.plan.rays}, c.plan.filterRadius,
                                      uint32_t{c.plan.edge}, uint32_t{c.plan.tiled && !c.plan.filterRow},
                                      uint32_t{c.plan.filterRow}, uint32_t{inPairs(c)},
                                      uint32_t{c.plan.polynomialWeights}},
                           {{1, inPairs(c) ? VK_FORMAT_R16G16_UINT : kDepthTexels}}})
    , counters_(c.work.counters) {
    for (uint32_t u = 0; u < kUploads; ++u) {
        bindings_[u] = gpu::Bindings(c.device, pipeline_,
                                     {&c.uploads[u].params, &c.uploads[u].depth, &c.work.rays, &c.work.masks,
                                      &c.work.list, &c.work.points},
                                     c.work.unused);
    }
}

void SurfacePass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.dispatchIndirect(pipeline_, bindings_[upload], counters_,
                              offsetof(shared::FrameCounters, patchGroups));
}

} // namespace fathom::cloud
