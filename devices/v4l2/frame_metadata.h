// SPDX-License-Identifier: Apache-2.0
// Per-frame metadata of a RealSense D4xx, from the metadata node of its video node. Sources:
// docs.kernel.org/userspace-api/media/v4l, pages metafmt-uvc and metafmt-d4xx.
#pragma once

#include "devices/v4l2/video_node.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace fathom {

// Time [s] from the start of the frame until its data were ready for USB, from a buffer of format D4XX; empty
// when the firmware does not report it, or the buffer is truncated.
std::optional<double> pipeLatencyOf(std::span<const uint8_t> buffer);

// Streams metadata from construction to destruction. One thread. Faults here never stop the frames: only
// std::bad_alloc is thrown.
class MetadataStream {
public:
    // Opens the metadata of that video node. nullptr when the kernel has no such node, or not in D4XX format
    // (a kernel that does not list the camera delivers plain payload headers).
    static std::unique_ptr<MetadataStream> openFor(const VideoNode& video);
    ~MetadataStream();
    MetadataStream(const MetadataStream&) = delete;
    MetadataStream& operator=(const MetadataStream&) = delete;

    // Start of exposure [s] of a frame, given its sequence number and driver stamp: the driver stamps the
    // first bytes over USB, the firmware reports the age of the frame at that time. Empty when it is not
    // reported.
    std::optional<double> exposureStart(uint32_t sequence, double stamp);

private:
    static constexpr uint32_t kBuffers = 8; // some frames are read late
    struct Reported {
        uint32_t sequence = 0;
        double stamp = 0.0;
        std::optional<double> latency;
    };
    explicit MetadataStream(int descriptor)
        : descriptor_(descriptor) {}
    bool start();
    void gather();

    int descriptor_;
    std::array<std::span<uint8_t>, kBuffers> buffers_;
    std::array<Reported, kBuffers> reported_{}; // the newest, as a ring buffer
    size_t next_ = 0;
};

} // namespace fathom
