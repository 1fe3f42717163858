// SPDX-License-Identifier: Apache-2.0
// One video stream: four mapped buffers that alternate between driver and camera.
#pragma once

#include "devices/v4l2/video_node.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

namespace fathom {

// Requested format; the driver may choose another rate, but not another size or format.
struct StreamRequest {
    uint32_t fourcc = 0;
    VideoSize size;     // [pixels]
    double rate = 30.0; // [1/s]
};

// One filled buffer, owned by the camera until it is returned to the stream.
struct CapturedBuffer {
    uint32_t index = 0;
    uint32_t sequence = 0;          // the driver's frame counter; a gap = lost frames
    double stamp = 0.0;             // [s] CLOCK_MONOTONIC, start of exposure where the driver knows it
    std::optional<double> exposure; // [s] start of exposure as reported by the camera
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> memory; // whole pages, starting at the first of `bytes`
    bool damaged = false;               // marked by the driver
};

// Frames missing between two values of the driver's counter, which wraps after 2^32 - 1. 0 when it went back,
// after a restart.
constexpr uint32_t missingBetween(uint32_t before, uint32_t after) {
    const uint32_t step = after - before;
    return step == 0 || step >= 1u << 31 ? 0 : step - 1;
}

// [s] CLOCK_MONOTONIC: a driver's stamp, or `now` where it is more than kAhead after it and so of another
// clock.
constexpr double usableStamp(double stamp, double now) {
    constexpr double kAhead = 0.005; // [s]
    return stamp > now + kAhead ? now : stamp;
}

// Streams from construction to destruction. One thread takes; any thread returns. Buffers stay mapped at the
// same addresses while the object or any user of their memory exists, even after the camera is unplugged.
class CaptureStream {
public:
    static constexpr uint32_t kBuffers = 4;

    // Throws BadInput, with the device's offer, for another format or size or too few buffers; DeviceLost
    // when it is unplugged meanwhile.
    CaptureStream(VideoNode node, const StreamRequest& request);
    ~CaptureStream();
    CaptureStream(const CaptureStream&) = delete;
    CaptureStream& operator=(const CaptureStream&) = delete;

    // The oldest frame that is ready, or nothing; never waits. Throws DeviceLost when the device is
    // unplugged.
    std::optional<CapturedBuffer> take();
    // Returns a buffer. No effect when the device is gone.
    void giveBack(uint32_t index) noexcept;
    // Restarts a silent stream. Frames that are still leased stay valid. Throws DeviceLost.
    void restart();

    const VideoNode& node() const { return node_; }
    const StreamRequest& request() const { return request_; }
    uint32_t stride() const { return stride_; }        // [bytes] from row to row; 0 when compressed
    double period() const { return period_; }          // [s] as the driver set it
    uint32_t queued() const { return queued_.load(); } // buffers that the driver can fill
    uint64_t missing() const { return missing_; }      // frames lost before take(): sequence gaps

private:
    void negotiate();
    void setRate();
    void map();
    bool queue(uint32_t index) noexcept;
    void start();
    [[noreturn]] void fail(const char* what) const;
    double stampOf(long seconds, long micros, uint32_t flags);

    VideoNode node_;
    StreamRequest request_;
    uint32_t stride_ = 0;
    double period_ = 0.0;
    struct Buffer {
        std::shared_ptr<void> pages; // mapped
        size_t size = 0;             // [bytes]
    };
    std::array<Buffer, kBuffers> buffers_;
    std::array<std::atomic<bool>, kBuffers> held_{}; // held by the camera
    std::atomic<uint32_t> queued_{0};
    std::mutex returning_; // keeps giveBack() out of restart(), which counts queued_ anew
    std::optional<uint32_t> lastSequence_;
    uint64_t missing_ = 0;
    bool ahead_ = false; // a stamp was, and it is logged
};

} // namespace fathom
