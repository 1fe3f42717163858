// SPDX-License-Identifier: Apache-2.0
// Batches on the GPU (shaders/smallest_gap.comp): the smallest gap of a tool at many poses in one submission.
// The device lists a few pairs per pose, and the host decides in float64.
#pragma once

#include "engine/cloud/device_query.h"
#include "engine/contact/smallest_gap.h"
#include "shaders/shared/gap_params.h"

#include <span>
#include <vector>

namespace fathom::cloud {

// One thread. Shares the queue for contact queries. A query is a batch.
class GapQuery : public DeviceQuery {
public:
    // capacity: pairs in the first answer; it grows when one does not fit.
    explicit GapQuery(const QueryContext& context, uint32_t capacity = 4096);

    // One answer per pose, as smallest_gap.h defines it. Blocks until the device has finished. Poses more
    // than 20 m from the set's origin are searched on the host, because float32 leaves too many pairs there.
    // tool: the one of setTool(). Throws DeviceFailed.
    void find(const FixtureSet& set, const Tool& tool, std::span<const Pose> baseTtool,
              std::vector<SmallestGap>& out);

    uint32_t pairs() const { return found_; } // that the device listed in the last submission

private:
    // Poses of one submission: their indices in the batch.
    using Part = std::span<const uint32_t>;
    struct Batch {
        const FixtureSet& set;
        const Tool& tool;
        std::span<const Pose> poses;
        std::vector<SmallestGap>& out;
    };
    const gpu::Bindings& bindingsOf(const FixtureSet& set);
    void reserve(size_t poses);
    void writePoses(const Batch& batch, Part part);
    void ask(const Batch& batch, Part part);
    void askHost(const Batch& batch, uint32_t pose);
    bool submit(const Batch& batch, Part part);
    void record(const Batch& batch, Part part);
    void copyPairs(gpu::Commands& commands, uint32_t pairs);
    bool growTo(uint32_t pairs);
    void decide(const Batch& batch, Part part);

    gpu::Buffer poses_; // GapPose per pose
    gpu::Buffer answer_, back_;
    uint32_t most_ = 0, copied_ = 0, found_ = 0; // pairs
    gpu::Buffer unused_;
    std::vector<uint32_t> near_; // poses for the device
    GapSearch host_;
    bool hostReady_ = false; // it searches the set of this batch
};

} // namespace fathom::cloud
