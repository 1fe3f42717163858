// SPDX-License-Identifier: Apache-2.0
// An endless camera of stored frames, because a pilot's session lasts longer than a scripted scene.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Stores `count` frames and plays them forwards and backwards. For simulated cameras, which render slower
// than real time. Memory: up to 6 bytes per pixel and frame.
class ShuttleCamera final : public Camera {
public:
    // Stores fewer frames when the source ends or `stop` is set. Calls progress(frames so far) after each.
    // Throws Error when there are none.
    ShuttleCamera(std::unique_ptr<Camera> source, size_t count, const std::atomic<bool>& stop,
                  const std::function<void(size_t)>& progress);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return 0; }
    std::vector<std::string> warnings() const override { return warnings_; }
    std::string description() const override { return description_; }

private:
    struct Image {
        std::vector<uint16_t> depth;
        std::vector<std::byte> colours; // in the source's format
        RawColour raw;
        std::optional<Pose> baseTcamera;
    };
    CameraInfo info_;
    std::string description_;
    std::vector<Image> images_;
    std::unique_ptr<FrameSlots> slots_;
    uint32_t shown_ = 0;
    std::vector<std::string> warnings_; // of the source
};

} // namespace fathom
