// SPDX-License-Identifier: Apache-2.0
// Cameras that never end, from sources that do: a pilot's session lasts longer than any recording.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

namespace fathom {

// Opens the source again when it has ended. Index and source number go on counting. info() and description()
// may be asked from any thread.
class RepeatedCamera final : public Camera {
public:
    // Throws what open() throws.
    explicit RepeatedCamera(std::function<std::unique_ptr<Camera>()> open);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_ + source_->skipped(); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    std::string description() const override { return description_; }

private:
    std::function<std::unique_ptr<Camera>()> open_;
    std::unique_ptr<Camera> source_;
    CameraInfo info_; // of the first one, for readers on other threads
    std::string description_;
    std::vector<std::unique_ptr<Camera>> ended_; // kept while a lease may live
    uint32_t skipped_ = 0, offset_ = 0, next_ = 0;
};

// Takes `count` frames beforehand and shows them to and fro: for a camera that is simulated, so slower than
// the clock. Memory: 6 bytes per pixel and frame.
class ShuttleCamera final : public Camera {
public:
    // Fewer frames when the source ends or `stop`. progress(taken) after each. Throws Error when there is
    // none.
    ShuttleCamera(std::unique_ptr<Camera> source, size_t count, const std::atomic<bool>& stop,
                  const std::function<void(size_t)>& progress);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return 0; }
    std::string description() const override { return description_; }

private:
    struct Image {
        std::vector<uint16_t> depth;
        std::vector<uint32_t> colours; // as the source sent them
        std::optional<Pose> baseTcamera;
    };
    CameraInfo info_;
    std::string description_;
    std::vector<Image> images_;
    std::unique_ptr<FrameSlots> slots_;
    uint32_t shown_ = 0;
};

} // namespace fathom
