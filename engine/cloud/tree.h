// SPDX-License-Identifier: Apache-2.0
// The pass shaders/tree.comp: bounds over 4x4 children, from patches up to one root, for the GPU's
// query. Two dispatches: patches, then the rest.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class TreePass {
public:
    explicit TreePass(const CloudContext& context);
    void record(gpu::Commands& commands, uint32_t set) const;

private:
    struct Levels {
        Levels(const CloudContext& context, bool patches);
        gpu::Pipeline pipeline;
        std::vector<gpu::Bindings> bindings; // a set
    };
    Levels patches_, above_;
    const PatchLayout& layout_;
};

} // namespace fathom::cloud
