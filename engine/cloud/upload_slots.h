// SPDX-License-Identifier: Apache-2.0
// Where the device finds a frame's pictures: copied into one of two slots, or left where the camera wrote
// them.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/frame.h"

#include <optional>

namespace fathom::cloud {

// Slots 0 and 1 are copied into. A frame whose memory the device can import (Plan::inPlace) gets a slot of
// its own when that memory is seen first; a camera's few blocks come round again and again. One thread.
class UploadSlots {
public:
    static constexpr uint32_t kCopied = 2; // frames in flight: double-buffered
    // Pairs of depth and colour: of a live camera four of the driver's and five of its own. Memory that is
    // new after that is copied.
    static constexpr uint32_t kMost = 2 + 20;

    UploadSlots(const gpu::Device& device, const Plan& plan, const CameraInfo& camera);

    // Where one frame's frames go.
    struct Choice {
        uint32_t slot;
        bool isNew; // its buffers were made just now
    };
    // A slot for the frame, never the one that is in flight. Memory that nobody but a slot holds any more
    // makes room for memory that is new. A device that refuses to import both is asked for colour alone
    // (depth may lie in a driver's pages), and then not again.
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
    std::vector<Images> images_; // a slot
    uint32_t nextCopied_ = 0;
    bool depthRefused_ = false, refused_ = false;
};

} // namespace fathom::cloud
