// SPDX-License-Identifier: Apache-2.0
// The end of a frame: counters and marks of patches go to the host and are cleared for the next.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

#include <optional>

namespace fathom::cloud {

// The pass shaders/deliver.comp on a GPU, where each copy and each fill takes as long as a dispatch; copies
// and fills where the device is the CPU, which does these at once and starts its threads for a dispatch.
class DeliverPass {
public:
    explicit DeliverPass(const CloudContext& context);
    void record(gpu::Commands& commands, uint32_t set) const;
    // As a frame finds them: nothing counted, no patch marked.
    static void clear(gpu::Commands& commands, const WorkBuffers& work);

private:
    CloudContext context_;
    std::optional<gpu::Pipeline> pipeline_; // none: copies
    std::vector<gpu::Bindings> bindings_;   // a set
};

} // namespace fathom::cloud
