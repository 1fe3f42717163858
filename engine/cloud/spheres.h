// SPDX-License-Identifier: Apache-2.0
// The pass shaders/spheres.comp: region spheres, held points, sub-patch bounds of one fixture set.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

#include <optional>
#include <vector>

namespace fathom::cloud {

class SpheresPass {
public:
    explicit SpheresPass(const CloudContext& context);
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload
    void record(gpu::Commands& commands, uint32_t upload, uint32_t set) const;

private:
    struct Variant {
        Variant(const CloudContext& c, uint32_t hold); // kHold in shaders/spheres.comp
        gpu::Pipeline pipeline;
    };

    CloudContext context_;
    Variant first_;
    std::optional<Variant> holding_; // for patches whose memory holds points, where first_ is not for them
    PerUpload<std::vector<gpu::Bindings>> bindings_; // a set
};

} // namespace fathom::cloud
