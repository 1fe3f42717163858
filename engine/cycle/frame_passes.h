// SPDX-License-Identifier: Apache-2.0
// The planned passes of a frame in their order, with a stopwatch mark after each.
#pragma once

#include "engine/cloud/passes.h"
#include "engine/gpu/stopwatch.h"

#include <memory>
#include <string>
#include <vector>

namespace fathom {

// Pipelines exist only for passes in the plan. One thread.
class FramePasses {
public:
    explicit FramePasses(const cloud::CloudContext& context);

    // Binds the buffers of an upload slot. Call before its first frame() and whenever the buffers change. No
    // submission of that slot may be in flight.
    void bind(uint32_t upload, const cloud::UploadBuffers& buffers);

    // Commands of one frame, ready to submit. Recorded once per pair of slot and set, because only buffer
    // contents change between frames. No submission of the same slot may be in flight.
    const gpu::Commands& frame(uint32_t upload, uint32_t set);
    const std::vector<std::string>& names() const { return names_; }
    // Stopwatch of the pair used last; has no marks unless the plan times passes.
    const gpu::Stopwatch& watch(uint32_t upload) const { return *watches_[upload]; }

private:
    void record(gpu::Commands& commands, gpu::Stopwatch& watch, uint32_t upload, uint32_t set) const;
    void recordEnd(gpu::Commands& commands, uint32_t upload, uint32_t set) const;

    cloud::CloudContext context_;
    std::vector<cloud::Pass> passes_;
    std::unique_ptr<cloud::Pass> deliver_; // null: deliverByCopies()
    std::vector<std::string> names_;
    cloud::PerUpload<std::vector<std::unique_ptr<gpu::Commands>>> commands_; // per set; null = not recorded
    cloud::PerUpload<std::unique_ptr<gpu::Stopwatch>> watches_;
};

} // namespace fathom
