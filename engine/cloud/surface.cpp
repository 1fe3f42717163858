// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/surface.h"

#include "shaders/shared/frame_params.h"
#include "shaders/surface.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

namespace {

// A sub-patch an invocation: 16 do a patch. Pairs: smaller groups, of which more are under way.
uint32_t groupOf(const Plan& plan) {
    return plan.filterBlock ? 16u : std::min(plan.pixelGroup, plan.filterPairs() ? 64u : 256u);
}

bool inFours(const CloudContext& c) {
    return c.plan.filterBlock && c.camera.depth.width % 4 == 0;
}

} // namespace

SurfacePass::SurfacePass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device, {"surface",
                           surface_spv,
                           6,
                           true,
                           0,
                           std::array{groupOf(c.plan), uint32_t{c.plan.rays}, c.plan.filterRadius,
                                      uint32_t{c.plan.edge}, uint32_t{c.plan.tiled && !c.plan.filterBlock},
                                      uint32_t{c.plan.filterBlock}, uint32_t{inFours(c)},
                                      uint32_t{c.plan.polynomialWeights}, uint32_t{c.plan.filterPairs()}},
                           {{1, inFours(c) ? VK_FORMAT_R16G16B16A16_UINT : kDepthTexels}, {3, kMaskTexels}}})
    , counters_(c.work.counters) {}

void SurfacePass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload] =
        gpu::Bindings(context_.device, pipeline_,
                      {&up.params, &depthOf(w, up), &w.rays, &w.masks, &w.list, &w.points}, w.unused);
}

void SurfacePass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.dispatchIndirect(pipeline_, bindings_[upload], counters_,
                              offsetof(shared::FrameCounters, patchGroups));
}

} // namespace fathom::cloud
