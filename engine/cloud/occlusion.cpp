// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/occlusion.h"

#include "shaders/occlusion.h"

namespace fathom::cloud {

OcclusionPass::OcclusionPass(const CloudContext& c)
    : pipeline_(c.device, {"occlusion",
                           occlusion_spv,
                           4,
                           true,
                           0,
                           std::array{c.plan.pixelGroup, uint32_t{c.plan.rays}},
                           {{1, kDepthTexels}}})
    , nearest_(c.work.nearest)
    , groups_((c.camera.depth.pixels() + c.plan.pixelGroup - 1) / c.plan.pixelGroup) {
    for (uint32_t u = 0; u < kUploads; ++u) {
        bindings_[u] = gpu::Bindings(
            c.device, pipeline_, {&c.uploads[u].params, &c.uploads[u].depth, &c.work.rays, &c.work.nearest},
            c.work.unused);
    }
}

void OcclusionPass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.fill(nearest_, 0xffffffffu);
    commands.barrier();
    commands.dispatch(pipeline_, bindings_[upload], groups_);
}

} // namespace fathom::cloud
