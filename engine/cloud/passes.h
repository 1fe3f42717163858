// SPDX-License-Identifier: Apache-2.0
// Descriptors of the compute passes of a frame (shaders/README.md), as the plan requires.
#pragma once

#include "engine/cloud/pass.h"

namespace fathom::cloud {

// Where the bounds of the patches are.
shared::TreeParams treeParams(const PatchLayout& layout);

// All passes in the order in which they run, except `deliver`.
std::vector<PassInfo> framePasses(const CloudContext& context);

// Ends a frame: copies counters and patch marks for the host and clears them for the next frame. GPUs use the
// pass `deliver`, because there each copy or fill takes as long as a dispatch. CPU devices use
// deliverByCopies(), because there a dispatch starts threads. The pass also empties the bounds of
// unlisted patches.
PassInfo deliverPass(const CloudContext& context);
void deliverByCopies(gpu::Commands& commands, const WorkBuffers& work, const SetBuffers& set);
// Sets counters and patch marks to their state at the start of a frame.
void clearCounters(gpu::Commands& commands, const WorkBuffers& work);

} // namespace fathom::cloud
