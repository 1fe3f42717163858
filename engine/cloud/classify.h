// SPDX-License-Identifier: Apache-2.0
// The pass shaders/classify.comp: which pixels can matter, and which patches have work.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class ClassifyPass {
public:
    explicit ClassifyPass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload) const;

private:
    CloudContext context_;
    gpu::Pipeline pipeline_;
    PerUpload<gpu::Bindings> bindings_;
    std::array<uint32_t, 3> groups_; // patches across, down; groups a patch
};

} // namespace fathom::cloud
