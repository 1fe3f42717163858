// SPDX-License-Identifier: Apache-2.0
// Endless cameras made from finite sources, because a pilot's session lasts longer than a recording.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "engine/types/said_once.h"

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

namespace fathom {

// Reopens the source when it has ended, without logging the same lines again. Frame index and source number
// keep counting. Any thread may call info() and description().
class RepeatedCamera final : public Camera {
public:
    // Throws what open() throws.
    explicit RepeatedCamera(std::function<std::unique_ptr<Camera>()> open);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_ + source_->skipped(); }
    std::vector<std::string> warnings() const override { return source_->warnings(); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    std::shared_ptr<CameraControls> controls() const override { return controls_; }
    std::vector<CameraStream> delivered() const override { return source_->delivered(); }
    bool stampsExposure() const override { return stampsExposure_.load(); }
    std::string description() const override { return description_; }

private:
    log::SaidLines said_; // before source_, which logs when it is opened
    std::function<std::unique_ptr<Camera>()> open_;
    std::unique_ptr<Camera> source_;
    CameraInfo info_; // of the first source; constant, because other threads read it
    std::string description_;
    std::shared_ptr<CameraControls> controls_;   // of a live source, which does not end
    std::atomic<bool> stampsExposure_{false};    // of the newest frame
    std::vector<std::unique_ptr<Camera>> ended_; // kept while frames still lease their memory
    uint32_t skipped_ = 0, offset_ = 0, next_ = 0;
};

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
