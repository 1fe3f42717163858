// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/spheres.h"

#include "shaders/shared/frame_params.h"
#include "shaders/spheres.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

namespace {

// Smaller groups wait for less at a time, larger ones are sooner done with a patch.
uint32_t spheresGroup(const Plan& plan) {
    return !plan.byPixel ? plan.subGroup : std::min(plan.pixelGroup, plan.manyPatches ? 128u : 256u);
}

} // namespace

SpheresPass::Variant::Variant(const CloudContext& c, uint32_t hold)
    : pipeline(c.device, {"spheres",
                          spheres_spv,
                          27,
                          true,
                          0,
                          std::array{spheresGroup(c.plan), uint32_t{c.plan.thin}, hold,
                                     uint32_t{c.plan.byPixel}, uint32_t{c.plan.leaks}, c.plan.classes,
                                     uint32_t{c.plan.fan}, uint32_t{c.plan.beam}, uint32_t{c.plan.tree},
                                     uint32_t{c.plan.pack}, uint32_t{c.plan.memoryTexels}},
                          {{1, kDepthTexels},
                           {2, kMaskTexels},
                           {3, kPointTexels},
                           {6, VK_FORMAT_R32G32B32A32_SFLOAT},
                           {18, VK_FORMAT_R32G32B32A32_SFLOAT},
                           {19, VK_FORMAT_R32G32B32A32_SFLOAT},
                           {20, VK_FORMAT_R32_UINT}}}) {}

SpheresPass::SpheresPass(const CloudContext& c)
    : context_(c)
    , first_(c, !c.plan.hold     ? 0
                : c.plan.byPixel ? 3
                                 : 1) {
    if (c.plan.hold && !c.plan.byPixel) {
        holding_.emplace(c, 2u);
    }
}

void SpheresPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload].clear();
    for (const SetBuffers* s : context_.sets) {
        bindings_[upload].emplace_back(
            context_.device, first_.pipeline,
            std::initializer_list<const gpu::Buffer*>{
                &up.params,  &depthOf(w, up), &w.masks,    &w.points,  &w.listed,   &w.list,
                &w.growth,   &w.counters,     &w.seen,     &w.kept,    &w.keptTime, &w.live,
                &s->spheres, &s->held,        &w.classes,  &s->bits,   &s->nodes,   &s->nodeCounts,
                &w.seen,     &w.kept,         &w.keptTime, &s->packed, &s->places,  &s->runs,
                &w.radii,    &w.heldRadii,    &w.growth},
            w.unused);
    }
}

void SpheresPass::record(gpu::Commands& commands, uint32_t upload, uint32_t set) const {
    const WorkBuffers& w = context_.work;
    if (context_.plan.hold && !context_.plan.byPixel) { // else a patch's group knows all of it
        commands.fill(w.live, 0);                       // classify has read it; counted anew below
        commands.barrier();
    }
    const auto dispatch = [&](const gpu::Pipeline& pipeline, size_t groups) {
        commands.dispatchIndirect(pipeline, bindings_[upload][set], w.counters, groups);
    };
    if (!holding_) {
        dispatch(first_.pipeline, context_.plan.byPixel ? offsetof(shared::FrameCounters, patchGroups)
                                                        : offsetof(shared::FrameCounters, subGroups));
        return;
    }
    dispatch(first_.pipeline, offsetof(shared::FrameCounters, quietGroups));
    commands.barrier();
    dispatch(holding_->pipeline, offsetof(shared::FrameCounters, holdingGroups));
}

} // namespace fathom::cloud
