// SPDX-License-Identifier: Apache-2.0
// The pass shaders/moments.comp: moments of the guidance classes in each guided patch.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class MomentsPass {
public:
    explicit MomentsPass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload, uint32_t set) const;

private:
    CloudContext context_;
    gpu::Pipeline pipeline_;
    PerUpload<std::vector<gpu::Bindings>> bindings_; // a set
    const gpu::Buffer& counters_;
};

} // namespace fathom::cloud
