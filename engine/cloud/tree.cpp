// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/tree.h"

#include "shaders/shared/frame_params.h"
#include "shaders/tree.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

// The levels above the patches are one group's: on a GPU a larger one, whose invocations wait for memory side
// by side.
uint32_t groupOf(const Plan& plan, bool patches) {
    return !patches && plan.byPixel ? std::max(plan.subGroup, plan.pixelGroup) : plan.subGroup;
}

} // namespace

TreePass::Levels::Levels(const CloudContext& c, bool patches)
    : pipeline(c.device, {"tree",
                          tree_spv,
                          6,
                          false,
                          sizeof(shared::TreeParams),
                          std::array{groupOf(c.plan, patches), uint32_t{patches}},
                          {{4, VK_FORMAT_R32G32B32A32_SFLOAT}, {5, VK_FORMAT_R32G32B32A32_UINT}}}) {
    for (const SetBuffers* s : c.sets) {
        bindings.emplace_back(c.device, pipeline,
                              std::initializer_list<const gpu::Buffer*>{&c.work.listed, &s->nodes,
                                                                        &s->nodeCounts, &c.work.counters,
                                                                        &s->nodes, &s->nodeCounts},
                              c.work.unused);
    }
}

TreePass::TreePass(const CloudContext& c)
    : patches_(c, true)
    , above_(c, false)
    , layout_(c.layout) {}

void TreePass::record(gpu::Commands& commands, uint32_t set) const {
    shared::TreeParams params{};
    const auto levels = static_cast<uint32_t>(layout_.levels.size());
    for (uint32_t l = 0; l < levels; ++l) {
        params.levels[l] = {layout_.levels[l].across, layout_.levels[l].down, layout_.levels[l].first, 0};
    }
    params.run = {1, 1, levels, 0};
    const uint32_t group = patches_.pipeline.groupSize();
    commands.dispatch(patches_.pipeline, patches_.bindings[set], (layout_.patches() + group - 1) / group,
                      &params);
    commands.barrier();
    params.run = {2, levels - 1, levels, 0};
    commands.dispatch(above_.pipeline, above_.bindings[set], 1, &params);
}

} // namespace fathom::cloud
