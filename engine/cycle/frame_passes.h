// SPDX-License-Identifier: Apache-2.0
// The passes of a frame in their order, as the plan asks for them, with a mark of the stopwatch after each.
#pragma once

#include "engine/cloud/classify.h"
#include "engine/cloud/deliver.h"
#include "engine/cloud/list.h"
#include "engine/cloud/moments.h"
#include "engine/cloud/occlusion.h"
#include "engine/cloud/spheres.h"
#include "engine/cloud/surface.h"
#include "engine/cloud/thin.h"
#include "engine/cloud/tree.h"
#include "engine/gpu/stopwatch.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Pipelines exist only for what the plan has in. One thread.
class FramePasses {
public:
    explicit FramePasses(const cloud::CloudContext& context);

    // The buffers that frames are uploaded to as `upload`, before its first frame() and whenever they are
    // new. No submission of that upload may be in flight.
    void bind(uint32_t upload, const cloud::UploadBuffers& buffers);

    // One frame, ready to submit. Nothing in it changes from
    // frame to frame but what buffers hold, so it is recorded at the pair's first use only. No submission of
    // the same upload may be in flight.
    const gpu::Commands& frame(uint32_t upload, uint32_t set);
    const std::vector<std::string>& names() const { return names_; }
    // Of the pair used last; without a mark where the plan asks for no times of passes.
    const gpu::Stopwatch& watch(uint32_t upload) const { return *watches_[upload]; }

private:
    void record(gpu::Commands& commands, gpu::Stopwatch& watch, uint32_t upload, uint32_t set) const;
    void recordCopies(gpu::Commands& commands, uint32_t set) const;

    const cloud::WorkBuffers& work_;
    std::vector<cloud::SetBuffers*> sets_;
    std::optional<cloud::OcclusionPass> occlusion_;
    std::optional<cloud::ClassifyPass> classify_;
    std::optional<cloud::ListPass> list_;
    std::optional<cloud::SurfacePass> surface_;
    std::optional<cloud::ThinPass> thin_;
    std::optional<cloud::SpheresPass> spheres_;
    std::optional<cloud::TreePass> tree_;
    std::optional<cloud::MomentsPass> moments_;
    std::optional<cloud::DeliverPass> deliver_;
    std::vector<std::string> names_;
    const gpu::Device& device_;
    bool timed_;
    cloud::PerUpload<std::vector<std::unique_ptr<gpu::Commands>>> commands_; // a set; null = not yet
    cloud::PerUpload<std::unique_ptr<gpu::Stopwatch>> watches_;
};

} // namespace fathom
