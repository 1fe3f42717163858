// SPDX-License-Identifier: Apache-2.0
// The passes of a frame in their order, as the plan asks for them, with a mark of the stopwatch after each.
#pragma once

#include "engine/cloud/classify.h"
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

    // Records one frame: passes, then the copies that the host reads.
    void record(gpu::Commands& commands, gpu::Stopwatch& watch, uint32_t upload, uint32_t set) const;
    const std::vector<std::string>& names() const { return names_; }

    gpu::Commands& commands(uint32_t upload) const { return *commands_[upload]; }
    gpu::Stopwatch& watch(uint32_t upload) const { return *watches_[upload]; }

private:
    void recordCopies(gpu::Commands& commands, uint32_t set) const;

    const cloud::WorkBuffers& work_;
    std::vector<cloud::SetBuffers*> sets_;
    std::optional<cloud::OcclusionPass> occlusion_;
    std::optional<cloud::ClassifyPass> classify_;
    std::optional<cloud::SurfacePass> surface_;
    std::optional<cloud::ThinPass> thin_;
    std::optional<cloud::SpheresPass> spheres_;
    std::optional<cloud::TreePass> tree_;
    std::optional<cloud::MomentsPass> moments_;
    std::vector<std::string> names_;
    std::array<std::unique_ptr<gpu::Commands>, cloud::kUploads> commands_;
    std::array<std::unique_ptr<gpu::Stopwatch>, cloud::kUploads> watches_;
};

} // namespace fathom
