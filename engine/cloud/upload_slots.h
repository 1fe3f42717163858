// SPDX-License-Identifier: Apache-2.0
// Chooses where the device reads a frame's images: from one slot after a copy, or in place in the camera's
// memory.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/frame.h"

#include <optional>

namespace fathom::cloud {

// Frames are copied to slot 0. Memory that the device can import (Plan::inPlace) gets its own slot when it is
// first seen, because a camera reuses a few blocks. One frame at a time: no submission may be in flight. One
// thread.
class UploadSlots {
public:
    static constexpr uint32_t kCopied = 0; // slot of copied frames
    // Slots for pairs of depth and colour memory: a live camera has four blocks in the driver and five of its
    // own. When all are in use, new memory is copied.
    static constexpr uint32_t kMax = 1 + 20;

    UploadSlots(const gpu::Device& device, const Plan& plan, const CameraInfo& camera);

    // The slot for one frame.
    struct Choice {
        uint32_t slot;
        bool isNew; // its buffers have just been created
    };
    // Returns a slot for the frame. Slots whose memory has no other owner are reused for new memory. If the
    // device cannot import both images, tries colour alone (depth may be in a driver's pages), then stops
    // trying.
    Choice choose(const Frame& frame);

    const UploadBuffers& operator[](uint32_t slot) const { return *slots_[slot]; }

private:
    struct Images {
        std::shared_ptr<const void> depth, colour; // null: copied
    };
    Images inPlace(const Frame& frame) const;
    std::optional<uint32_t> find(const Images& images) const;
    std::optional<uint32_t> room() const;
    bool import(uint32_t slot, const Images& images);

    const gpu::Device& device_;
    const Plan& plan_;
    const CameraInfo& camera_;
    std::vector<std::unique_ptr<UploadBuffers>> slots_;
    std::vector<Images> images_; // one per slot
    bool depthRefused_ = false, refused_ = false;
};

} // namespace fathom::cloud
