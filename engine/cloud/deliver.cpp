// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/deliver.h"

#include "shaders/deliver.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

static_assert(offsetof(shared::FrameCounters, nodes) == shared::kArgumentWords * sizeof(uint32_t));

DeliverPass::DeliverPass(const CloudContext& c)
    : context_(c) {
    if (!c.plan.delivers()) {
        return;
    }
    pipeline_.emplace(c.device,
                      gpu::PipelineInfo{"deliver", deliver_spv, 4, false, 0, std::array{c.plan.subGroup}});
    for (const SetBuffers* s : c.sets) {
        bindings_.emplace_back(c.device, *pipeline_,
                               std::initializer_list<const gpu::Buffer*>{&c.work.counters, &c.work.listed,
                                                                         &s->counters, &s->listed},
                               c.work.unused);
    }
}

void DeliverPass::clear(gpu::Commands& commands, const WorkBuffers& work) {
    shared::FrameCounters zero{};
    zero.patchGroups = zero.subGroups = zero.guidedGroups = {0, 1, 1, 0};
    zero.quietGroups = zero.holdingGroups = {0, 1, 1, 0};
    commands.update(work.counters, 0, sizeof(zero), &zero);
    commands.fill(work.listed, 0);
}

void DeliverPass::record(gpu::Commands& commands, uint32_t set) const {
    const WorkBuffers& w = context_.work;
    if (pipeline_) {
        const auto words =
            std::max<uint32_t>(sizeof(shared::FrameCounters) / sizeof(uint32_t), context_.layout.patches());
        const uint32_t group = pipeline_->groupSize();
        commands.dispatch(*pipeline_, bindings_[set], (words + group - 1) / group);
        return;
    }
    const SetBuffers& s = *context_.sets[set];
    commands.copy(w.counters, s.counters, w.counters.bytes());
    commands.copy(w.listed, s.listed, w.listed.bytes());
    commands.barrier();
    clear(commands, w);
}

} // namespace fathom::cloud
