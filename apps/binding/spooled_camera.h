// SPDX-License-Identifier: Apache-2.0
// All frames of a slow source, stored in an unnamed file beforehand and delivered at the speed of a copy.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// For sources slower than their frame rate, such as a simulated camera that renders longer than a frame
// period. The file has no name and vanishes with the process.
class SpooledCamera final : public Camera {
public:
    // Stores frames until the source ends or `stop`, at least one. `folder`: location of the file. Calls
    // progress(frames so far) after each. still: takes one frame only, and delivers it this many times, for
    // runs that use no pixel. Throws Error with the folder, and passes on exceptions of the source.
    SpooledCamera(std::unique_ptr<Camera> source, const std::filesystem::path& folder,
                  const std::atomic<bool>& stop, const std::function<void(uint64_t)>& progress,
                  std::optional<uint32_t> still = std::nullopt);
    ~SpooledCamera() override;

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    std::vector<std::string> warnings() const override { return warnings_; }
    std::string description() const override { return description_; }

private:
    void store(const Frame& frame);
    void writeAll(const void* bytes, size_t count);
    void readAll(void* bytes, size_t count);
    [[noreturn]] void fail(const char* what) const;

    CameraInfo info_;
    std::string description_, folder_;
    uint32_t skipped_ = 0;
    std::vector<std::string> warnings_; // of the source
    int descriptor_ = -1;
    struct StoredFrame {
        Frame::Content content; // without its pixels
        size_t colourBytes = 0;
    };
    std::vector<StoredFrame> stored_;
    size_t count_ = 0, next_ = 0;    // frames that it delivers; has delivered
    int64_t written_ = 0, read_ = 0; // [bytes]
    std::unique_ptr<FrameSlots> slots_;
};

// What a run that waits for the frames logs once, after a second: what is rendered and about how long it
// takes, with `done` of `all` frames in `seconds`. Empty: nothing to say yet.
std::string spoolNotice(uint64_t done, uint64_t all, double seconds);

} // namespace fathom
