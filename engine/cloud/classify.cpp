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

// How many of depth and registered colour are fetched in fours.
uint32_t inFours(const CloudContext& c) {
    return c.camera.depth.width % 4 != 0 ? 0u : (colourMode(c.plan) == 1 ? 2u : 1u);
}

VkFormat colourTexels(const CloudContext& c) {
    if (inFours(c) == 2) {
        return c.plan.yuyv ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT;
    }
    return kColourTexels; // a pixel, or Y0, U, Y1, V
}

// Four pixels of one row an invocation, or of four: 64 or 16 do a patch, 256 of a wide group four patches.
uint32_t rowsOf(const Plan& plan) {
    return plan.byPixel ? 1u : 4u;
}
uint32_t invocationsOf(const Plan& plan) {
    return plan.byPixel ? 256u : 64u / rowsOf(plan);
}
uint32_t classifyGroup(const Plan& plan) {
    return std::min(invocationsOf(plan), plan.pixelGroup);
}

} // namespace

ClassifyPass::ClassifyPass(const CloudContext& c)
    : context_(c)
    , pipeline_(
          c.device,
          {"classify",
           classify_spv,
           12,
           true,
           0,
           std::array{classifyGroup(c.plan), uint32_t{c.plan.rays}, colourMode(c.plan), uint32_t{c.plan.hold},
                      c.plan.subGroup, c.plan.classes, uint32_t{c.plan.box}, uint32_t{c.plan.groupCounts},
                      inFours(c), uint32_t{c.plan.range}, uint32_t{c.plan.selfFilter}, uint32_t{c.plan.water},
                      rowsOf(c.plan), uint32_t{c.plan.byPixel}, uint32_t{c.plan.keepDepth},
                      uint32_t{c.plan.moments}, uint32_t{!c.plan.lists()}, uint32_t{c.plan.yuyv}},
           {{1, inFours(c) != 0 ? VK_FORMAT_R16G16B16A16_UINT : kDepthTexels}, {3, colourTexels(c)}}})
    , groups_{c.plan.byPixel ? (c.layout.across + 3) / 4 : c.layout.across, c.layout.down,
              invocationsOf(c.plan) / classifyGroup(c.plan)} {}

void ClassifyPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload] = gpu::Bindings(context_.device, pipeline_,
                                      {&up.params, &up.depth, &w.rays, &up.colour, &w.nearest, &w.masks,
                                       &w.listed, &w.list, &w.counters, &w.live, &up.arm, &w.depth},
                                      w.unused);
}

void ClassifyPass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.dispatch(pipeline_, bindings_[upload], groups_);
}

} // namespace fathom::cloud
