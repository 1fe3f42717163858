// SPDX-License-Identifier: Apache-2.0
// The pass shaders/moments.comp: moments of the guidance classes in each listed patch.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class MomentsPass {
public:
    explicit MomentsPass(const CloudContext& context);
    void record(gpu::Commands& commands, uint32_t upload, uint32_t set) const;

private:
    gpu::Pipeline pipeline_;
    std::vector<std::array<gpu::Bindings, kUploads>> bindings_; // a set
    const gpu::Buffer& counters_;
};

} // namespace fathom::cloud
