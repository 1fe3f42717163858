// SPDX-License-Identifier: Apache-2.0
// The device side of the frame cadence: buffers, passes, and the timeline that orders submissions.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/cloud/upload_slots.h"
#include "engine/cycle/frame_passes.h"
#include "engine/gpu/timeline.h"

#include <string>
#include <vector>

namespace fathom {

// Frame thread only. Every submission waits for the one before.
class FrameDevice {
public:
    // Compiles every pipeline. Referenced objects must outlive this.
    FrameDevice(gpu::Device& device, const Plan& plan, const PatchLayout& layout, const CameraInfo& camera,
                cloud::FixturePool& pool);
    ~FrameDevice();
    FrameDevice(const FrameDevice&) = delete;
    FrameDevice& operator=(const FrameDevice&) = delete;

    // The upload slot for a frame. The last submission must have completed.
    uint32_t slotFor(const Frame& frame);
    const cloud::UploadBuffers& upload(uint32_t slot) const { return uploads_[slot]; }

    // The passes from an upload slot to a set of the pool, for submit().
    const gpu::Commands& frame(uint32_t slot, uint32_t set) { return passes_.frame(slot, set); }
    void submit(const gpu::Commands& commands);
    // Waits for the last submission. Throws DeviceLost.
    void wait() const { timeline_.wait(ticket_); }
    // The timeline point at which the last submission's passes have completed.
    gpu::Device::TimelinePoint completed() const { return {timeline_.handle(), ticket_}; }
    // Clears held points, estimates and counters. Waits for the device.
    void clearMemory();

    const std::vector<std::string>& passNames() const { return passes_.names(); }
    // [ms] per pass of the last frame from this slot. Throws DeviceFailed.
    std::vector<double> passMs(uint32_t slot) const { return passes_.watch(slot).intervalsMs(); }
    const cloud::WorkBuffers& work() const { return work_; }

private:
    gpu::Device& device_;
    cloud::WorkBuffers work_;
    cloud::UploadSlots uploads_;
    std::vector<cloud::SetBuffers*> sets_;
    FramePasses passes_;
    gpu::Timeline timeline_;
    uint64_t ticket_ = 0; // timeline value of the last submission
};

} // namespace fathom
