// SPDX-License-Identifier: Apache-2.0
// Ends a frame: copies counters and patch marks for the host and clears them.
#include "engine/cloud/passes.h"

#include "shaders/deliver.h"
#include "shaders/shared/constants.h"

#include <algorithm>

namespace fathom::cloud {

using namespace shared;

PassInfo deliverPass(const CloudContext& c) {
    const uint32_t words = std::max<uint32_t>(sizeof(FrameCounters) / sizeof(uint32_t), c.layout.patches());
    const uint32_t group = c.plan.subPatchGroup;
    return {"deliver",
            deliver_spv,
            {&WorkBuffers::counters, &WorkBuffers::listed, &SetBuffers::counters, &SetBuffers::listed,
             &SetBuffers::nodes, &SetBuffers::nodeCounts},
            {{kSpecGroupSize, group}, {kSpecTree, c.plan.tree}},
            Groups{(words + group - 1) / group, 1, 1},
            After::Barrier,
            treeParams(c.layout)};
}

void deliverByCopies(gpu::Commands& commands, const WorkBuffers& work, const SetBuffers& set) {
    commands.copy(work.counters, set.counters, work.counters.bytes());
    commands.copy(work.listed, set.listed, work.listed.bytes());
    commands.barrier();
    clearCounters(commands, work);
}

void clearCounters(gpu::Commands& commands, const WorkBuffers& work) {
    FrameCounters zero{};
    zero.patchGroups = zero.subPatchGroups = zero.guidedGroups = {0, 1, 1, 0};
    zero.withoutHeldGroups = zero.withHeldGroups = {0, 1, 1, 0};
    commands.update(work.counters, 0, sizeof(zero), &zero);
    commands.fill(work.listed, 0);
}

} // namespace fathom::cloud
