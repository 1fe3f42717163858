// SPDX-License-Identifier: Apache-2.0
// The compute passes of a frame (shaders/README.md), described as the plan wants them.
#pragma once

#include "engine/cloud/pass.h"

namespace fathom::cloud {

// In the order in which they run, without `deliver`.
std::vector<PassInfo> framePasses(const CloudContext& context);

// The end of a frame: counters and marks of patches go to the host and are cleared for the next frame. On
// GPUs that is the pass `deliver`, because each copy and each fill takes as long as a dispatch. On CPU
// devices, where a dispatch starts threads, deliverByCopies() does it.
PassInfo deliverPass(const CloudContext& context);
void deliverByCopies(gpu::Commands& commands, const WorkBuffers& work, const SetBuffers& set);
// As each frame finds them: nothing counted, no patch marked.
void clearCounters(gpu::Commands& commands, const WorkBuffers& work);

} // namespace fathom::cloud
