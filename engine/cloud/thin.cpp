// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/thin.h"

#include "shaders/shared/frame_params.h"
#include "shaders/thin.h"

#include <cstddef>

namespace fathom::cloud {

ThinPass::ThinPass(const CloudContext& c)
    : pipeline_(
          c.device,
          {"thin", thin_spv, 7, true, 0, std::array{c.plan.subGroup, c.plan.classes}, {{2, kPointTexels}}})
    , counters_(c.work.counters) {
    for (uint32_t u = 0; u < kUploads; ++u) {
        bindings_[u] = gpu::Bindings(c.device, pipeline_,
                                     {&c.uploads[u].params, &c.work.masks, &c.work.points, &c.work.listed,
                                      &c.work.list, &c.work.counters, &c.work.growth},
                                     c.work.unused);
    }
}

void ThinPass::record(gpu::Commands& commands, uint32_t upload) const {
    commands.dispatchIndirect(pipeline_, bindings_[upload], counters_,
                              offsetof(shared::FrameCounters, subGroups));
}

} // namespace fathom::cloud
