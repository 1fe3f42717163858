// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/moments.h"

#include "shaders/moments.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

namespace {

// Without shared memory an invocation does a patch; `guidedGroups` counts groups of subGroup / 16 patches.
uint32_t momentsGroup(const Plan& plan) {
    return plan.byPixel ? 16u : std::max(8u, plan.subGroup / 16u);
}

} // namespace

MomentsPass::MomentsPass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device, {"moments",
                           moments_spv,
                           6,
                           true,
                           0,
                           std::array{momentsGroup(c.plan), uint32_t{c.plan.byPixel}},
                           {{1, kMaskTexels}, {2, kPointTexels}}})
    , counters_(c.work.counters) {}

void MomentsPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload].clear();
    for (const SetBuffers* s : context_.sets) {
        bindings_[upload].emplace_back(context_.device, pipeline_,
                                       std::initializer_list<const gpu::Buffer*>{&up.params, &w.masks,
                                                                                 &w.points, &w.list,
                                                                                 &s->moments, &w.counters},
                                       w.unused);
    }
}

void MomentsPass::record(gpu::Commands& commands, uint32_t upload, uint32_t set) const {
    commands.dispatchIndirect(pipeline_, bindings_[upload][set], counters_,
                              offsetof(shared::FrameCounters, guidedGroups));
}

} // namespace fathom::cloud
