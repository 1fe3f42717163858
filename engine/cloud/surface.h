// SPDX-License-Identifier: Apache-2.0
// The pass shaders/surface.comp: filtered base-frame points of the listed patches.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class SurfacePass {
public:
    explicit SurfacePass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload) const;

private:
    CloudContext context_;
    gpu::Pipeline pipeline_;
    PerUpload<gpu::Bindings> bindings_;
    const gpu::Buffer& counters_;
};

} // namespace fathom::cloud
