// SPDX-License-Identifier: Apache-2.0
// The pass shaders/pack.comp: region spheres from their slots into one row without gaps, for the host.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

namespace fathom::cloud {

class PackPass {
public:
    explicit PackPass(const CloudContext& context);
    void record(gpu::Commands& commands, uint32_t set) const;

private:
    gpu::Pipeline pipeline_;
    std::vector<gpu::Bindings> bindings_; // a set
    const gpu::Buffer& counters_;
};

} // namespace fathom::cloud
