// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/occlusion.h"

#include "shaders/occlusion.h"

namespace fathom::cloud {

OcclusionPass::OcclusionPass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device, {"occlusion",
                           occlusion_spv,
                           4,
                           true,
                           0,
                           std::array{c.plan.pixelGroup, uint32_t{c.plan.rays}},
                           {{1, kDepthTexels}}})
    , nearest_(c.work.nearest)
    , groups_((c.camera.depth.pixels() + c.plan.pixelGroup - 1) / c.plan.pixelGroup) {}

void OcclusionPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload] =
        gpu::Bindings(context_.device, pipeline_, {&up.params, &up.depth, &w.rays, &w.nearest}, w.unused);
}

void OcclusionPass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.fill(nearest_, 0xffffffffu);
    commands.barrier();
    commands.dispatch(pipeline_, bindings_[upload], groups_);
}

} // namespace fathom::cloud
