// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/tree.h"

#include "shaders/shared/frame_params.h"
#include "shaders/tree.h"

namespace fathom::cloud {

TreePass::TreePass(const CloudContext& c)
    : pipeline_(c.device,
                {"tree", tree_spv, 5, false, sizeof(shared::TreeParams), std::array{c.plan.subGroup}})
    , layout_(c.layout) {
    for (const SetBuffers* s : c.sets) {
        bindings_.emplace_back(c.device, pipeline_,
                               std::initializer_list<const gpu::Buffer*>{&c.work.listed, &s->nodes,
                                                                         &s->nodeCounts, &c.work.counters,
                                                                         &c.work.begins},
                               c.work.unused);
    }
}

void TreePass::record(gpu::Commands& commands, uint32_t set) const {
    shared::TreeParams params{};
    const auto levels = static_cast<uint32_t>(layout_.levels.size());
    for (uint32_t l = 0; l < levels; ++l) {
        params.levels[l] = {layout_.levels[l].across, layout_.levels[l].down, layout_.levels[l].first, 0};
    }
    params.run = {1, 1, levels, 0};
    const uint32_t group = pipeline_.groupSize();
    commands.dispatch(pipeline_, bindings_[set], (layout_.patches() + group - 1) / group, &params);
    commands.barrier();
    params.run = {2, levels - 1, levels, 1};
    commands.dispatch(pipeline_, bindings_[set], 1, &params);
}

} // namespace fathom::cloud
