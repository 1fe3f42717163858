// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/thin.h"

#include "shaders/shared/frame_params.h"
#include "shaders/thin.h"

#include <cstddef>

namespace fathom::cloud {

ThinPass::ThinPass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device, {"thin",
                           thin_spv,
                           7,
                           true,
                           0,
                           std::array{c.plan.subGroup, c.plan.classes},
                           {{1, kMaskTexels}, {2, kPointTexels}}})
    , counters_(c.work.counters) {}

void ThinPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload] = gpu::Bindings(
        context_.device, pipeline_,
        {&up.params, &w.masks, &w.points, &w.listed, &w.list, &w.counters, &w.growth}, w.unused);
}

void ThinPass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.dispatchIndirect(pipeline_, bindings_[upload], counters_,
                              offsetof(shared::FrameCounters, subGroups));
}

} // namespace fathom::cloud
