// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/spheres.h"

#include "shaders/shared/frame_params.h"
#include "shaders/spheres.h"

#include <cstddef>

namespace fathom::cloud {

SpheresPass::SpheresPass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device, {"spheres",
                           spheres_spv,
                           26,
                           true,
                           0,
                           std::array{c.plan.byPixel ? c.plan.pixelGroup : c.plan.subGroup,
                                      uint32_t{c.plan.thin}, uint32_t{c.plan.hold}, uint32_t{c.plan.byPixel},
                                      uint32_t{c.plan.leaks}, c.plan.classes, uint32_t{c.plan.fan},
                                      uint32_t{c.plan.beam}, uint32_t{c.plan.tree}, uint32_t{c.plan.pack}},
                           {{1, kDepthTexels},
                            {2, kMaskTexels},
                            {3, kPointTexels},
                            {6, VK_FORMAT_R32G32B32A32_SFLOAT},
                            {18, VK_FORMAT_R32G32B32A32_SFLOAT},
                            {19, VK_FORMAT_R32G32B32A32_SFLOAT},
                            {20, VK_FORMAT_R32_UINT}}})
    , work_(c.work)
    , hold_(c.plan.hold)
    , byPixel_(c.plan.byPixel) {}

void SpheresPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload].clear();
    for (const SetBuffers* s : context_.sets) {
        bindings_[upload].emplace_back(
            context_.device, pipeline_,
            std::initializer_list<const gpu::Buffer*>{
                &up.params,  &depthOf(w, up), &w.masks,    &w.points,  &w.listed,   &w.list,
                &w.growth,   &w.counters,     &w.seen,     &w.kept,    &w.keptTime, &w.live,
                &s->spheres, &s->held,        &w.classes,  &s->bits,   &s->nodes,   &s->nodeCounts,
                &w.seen,     &w.kept,         &w.keptTime, &s->packed, &s->tags,    &s->runs,
                &w.radii,    &w.heldRadii},
            w.unused);
    }
}

void SpheresPass::record(gpu::Commands& commands, uint32_t upload, uint32_t set) const {
    if (hold_) {
        commands.fill(work_.live, 0); // classify has read it; counted anew below
        commands.barrier();
    }
    commands.dispatchIndirect(pipeline_, bindings_[upload][set], work_.counters,
                              byPixel_ ? offsetof(shared::FrameCounters, patchGroups)
                                       : offsetof(shared::FrameCounters, subGroups));
}

} // namespace fathom::cloud
