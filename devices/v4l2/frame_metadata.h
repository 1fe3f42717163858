// SPDX-License-Identifier: Apache-2.0
// What a RealSense D4xx tells of each picture, through the metadata node that the kernel has beside its video
// node. Sources: docs.kernel.org/userspace-api/media/v4l, pages metafmt-uvc and metafmt-d4xx.
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
// when the firmware does not tell it, or what is there is cut off.
std::optional<double> pipeLatencyOf(std::span<const uint8_t> buffer);

// Streams metadata from construction to destruction. One thread. Whatever goes wrong here, pictures go on
// without it: nothing throws but for want of memory.
class MetadataStream {
public:
    // Of the stream whose video node that is. nullptr where the kernel has no such node, or not in D4XX (a
    // kernel that does not list the camera gives bare payload headers).
    static std::unique_ptr<MetadataStream> beside(const VideoNode& video);
    ~MetadataStream();
    MetadataStream(const MetadataStream&) = delete;
    MetadataStream& operator=(const MetadataStream&) = delete;

    // When the exposure of that picture began [s], given its number and the driver's stamp of it: the driver
    // stamps the first bytes that come over USB, the firmware tells how old the frame was by then. Empty when
    // it is not told.
    std::optional<double> exposureStart(uint32_t sequence, double stamp);

private:
    static constexpr uint32_t kBuffers = 8; // some pictures are taken late
    struct Told {
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
    std::array<Told, kBuffers> told_{}; // the newest, in a ring
    size_t next_ = 0;
};

} // namespace fathom
