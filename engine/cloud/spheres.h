// SPDX-License-Identifier: Apache-2.0
// The pass shaders/spheres.comp: region spheres, held points, sub-patch bounds of one fixture set.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class SpheresPass {
public:
    explicit SpheresPass(const CloudContext& context);
    void record(gpu::Commands& commands, uint32_t upload, uint32_t set) const;

private:
    gpu::Pipeline pipeline_;
    std::vector<std::array<gpu::Bindings, kUploads>> bindings_; // a set
    const WorkBuffers& work_;
    bool hold_, byPixel_;
};

} // namespace fathom::cloud
