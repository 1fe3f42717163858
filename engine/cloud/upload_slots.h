// SPDX-License-Identifier: Apache-2.0
// Chooses where the device reads a frame's images: from one of two slots after a copy, or in place in the
// camera's memory.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/frame.h"

#include <optional>

namespace fathom::cloud {

// Frames are copied to slots 0 and 1. Memory that the device can import (Plan::inPlace) gets its own slot
// when it is first seen, because a camera reuses a few blocks. One thread.
class UploadSlots {
public:
    static constexpr uint32_t kCopied = 2; // frames in flight: double-buffered
    // Slots for pairs of depth and colour memory: a live camera has four blocks in the driver and five of its
    // own. When all are in use, new memory is copied.
    static constexpr uint32_t kMost = 2 + 20;

    UploadSlots(const gpu::Device& device, const Plan& plan, const CameraInfo& camera);

    // The slot for one frame.
    struct Choice {
        uint32_t slot;
        bool isNew; // its buffers have just been created
    };
    // Returns a slot for the frame, never the one in flight. Slots whose memory has no other owner are reused
    // for new memory. If the device cannot import both images, tries colour alone (depth may be in a driver's
    // pages), then stops trying.
    Choice choose(const Frame& frame, std::optional<uint32_t> inFlight);

    const UploadBuffers& operator[](uint32_t slot) const { return *slots_[slot]; }

private:
    struct Images {
        std::shared_ptr<const void> depth, colour; // null: copied
    };
    Images inPlace(const Frame& frame) const;
    std::optional<uint32_t> find(const Images& images) const;
    std::optional<uint32_t> room(std::optional<uint32_t> inFlight) const;
    bool import(uint32_t slot, const Images& images);
    uint32_t copied(std::optional<uint32_t> inFlight);

    const gpu::Device& device_;
    const Plan& plan_;
    const CameraInfo& camera_;
    std::vector<std::unique_ptr<UploadBuffers>> slots_;
    std::vector<Images> images_; // one per slot
    uint32_t nextCopied_ = 0;
    bool depthRefused_ = false, refused_ = false;
};

} // namespace fathom::cloud
