// SPDX-License-Identifier: Apache-2.0
// The pass shaders/occlusion.comp: nearest depth in each cell of the colour camera's picture.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class OcclusionPass {
public:
    explicit OcclusionPass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload) const;

private:
    CloudContext context_;
    gpu::Pipeline pipeline_;
    PerUpload<gpu::Bindings> bindings_;
    const gpu::Buffer& nearest_;
    uint32_t groups_;
};

} // namespace fathom::cloud
