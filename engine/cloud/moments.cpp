// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/moments.h"

#include "shaders/moments.h"
#include "shaders/shared/frame_params.h"

#include <cstddef>

namespace fathom::cloud {

MomentsPass::MomentsPass(const CloudContext& c)
    : pipeline_(c.device, {"moments", moments_spv, 5, true, 0, std::array{16u}, {{2, kPointTexels}}})
    , counters_(c.work.counters) {
    for (const SetBuffers* s : c.sets) {
        auto& perUpload = bindings_.emplace_back();
        for (uint32_t u = 0; u < kUploads; ++u) {
            perUpload[u] = gpu::Bindings(
                c.device, pipeline_,
                {&c.uploads[u].params, &c.work.masks, &c.work.points, &c.work.list, &s->moments},
                c.work.unused);
        }
    }
}

void MomentsPass::record(gpu::Commands& commands, uint32_t upload, uint32_t set) const {
    commands.dispatchIndirect(pipeline_, bindings_[set][upload], counters_,
                              offsetof(shared::FrameCounters, patchGroups));
}

} // namespace fathom::cloud
