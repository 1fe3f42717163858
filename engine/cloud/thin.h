// SPDX-License-Identifier: Apache-2.0
// The pass shaders/thin.comp: which points the error budget can do without.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class ThinPass {
public:
    explicit ThinPass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload) const;

private:
    CloudContext context_;
    gpu::Pipeline pipeline_;
    PerUpload<gpu::Bindings> bindings_;
    const gpu::Buffer& counters_;
};

} // namespace fathom::cloud
