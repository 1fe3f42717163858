// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/classify.h"

#include "shaders/classify.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

uint32_t colourMode(const Plan& plan) {
    return !plan.colour ? 0 : (plan.occlusion ? 2 : 1);
}

bool inFours(const CloudContext& c) {
    return c.camera.depth.width % 4 == 0;
}

// Four pixels an invocation: 64 do a patch.
uint32_t groupOf(const Plan& plan) {
    return std::min(64u, plan.pixelGroup);
}

} // namespace

ClassifyPass::ClassifyPass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device,
                {"classify",
                 classify_spv,
                 11,
                 true,
                 0,
                 std::array{groupOf(c.plan), uint32_t{c.plan.rays}, colourMode(c.plan), uint32_t{c.plan.hold},
                            c.plan.subGroup, c.plan.classes, uint32_t{c.plan.box},
                            uint32_t{c.plan.groupCounts}, uint32_t{inFours(c)}, uint32_t{c.plan.range},
                            uint32_t{c.plan.selfFilter}, uint32_t{c.plan.water}},
                 {{1, inFours(c) ? VK_FORMAT_R16G16B16A16_UINT : kDepthTexels}, {3, kColourTexels}}})
    , work_(c.work)
    , groups_{c.layout.across, c.layout.down, 64 / groupOf(c.plan)} {}

void ClassifyPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload] = gpu::Bindings(context_.device, pipeline_,
                                      {&up.params, &up.depth, &w.rays, &up.colour, &w.nearest, &w.masks,
                                       &w.listed, &w.list, &w.counters, &w.live, &up.arm},
                                      w.unused);
}

void ClassifyPass::record(gpu::Commands& commands, uint32_t upload) const {
    shared::FrameCounters zero{};
    zero.patchGroups = {0, 1, 1, 0};
    zero.subGroups = {0, 1, 1, 0};
    commands.update(work_.counters, 0, sizeof(zero), &zero);
    commands.fill(work_.listed, 0);
    commands.barrier();
    commands.dispatch(pipeline_, bindings_[upload], groups_);
}

} // namespace fathom::cloud
