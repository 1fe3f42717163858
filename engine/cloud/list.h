// SPDX-License-Identifier: Apache-2.0
// The pass shaders/list.comp: lists of the patches that classify has marked.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class ListPass {
public:
    explicit ListPass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload) const;

private:
    CloudContext context_;
    gpu::Pipeline pipeline_;
    PerUpload<gpu::Bindings> bindings_;
};

} // namespace fathom::cloud
