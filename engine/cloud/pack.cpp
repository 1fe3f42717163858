// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/pack.h"

#include "shaders/pack.h"
#include "shaders/shared/frame_params.h"

#include <cstddef>

namespace fathom::cloud {

PackPass::PackPass(const CloudContext& c)
    : pipeline_(c.device, {"pack", pack_spv, 7, false, 0, std::array{c.plan.subGroup, uint32_t{c.plan.hold}}})
    , counters_(c.work.counters) {
    for (const SetBuffers* s : c.sets) {
        bindings_.emplace_back(c.device, pipeline_,
                               std::initializer_list<const gpu::Buffer*>{
                                   &c.work.list, &c.work.begins, &slotSpheres(c.work, *s),
                                   &slotHeld(c.work, *s), &c.work.classes, &s->packed, &s->tags},
                               c.work.unused);
    }
}

void PackPass::record(gpu::Commands& commands, uint32_t set) const {
    commands.dispatchIndirect(pipeline_, bindings_[set], counters_,
                              offsetof(shared::FrameCounters, patchGroups));
}

} // namespace fathom::cloud
