// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/frame_metadata.h"

#include "devices/v4l2/little_endian.h"
#include "devices/v4l2/video_ioctl.h"

#include <algorithm>
#include <cmath>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <unistd.h>

namespace fathom {

namespace fs = std::filesystem;

namespace {

v4l2_buffer metadataBuffer(uint32_t index) {
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.type = V4L2_BUF_TYPE_META_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
}

// The driver creates it right after the video node: the next number of the same interface.
fs::path metadataNodeOf(const fs::path& video) {
    constexpr unsigned long kFar = 8; // other devices may use the numbers in between
    const std::string name = video.filename().string();
    const auto deviceOf = [](const std::string& node) {
        std::error_code failed;
        return fs::canonical("/sys/class/video4linux/" + node + "/device", failed);
    };
    const fs::path device = deviceOf(name);
    const unsigned long number = std::strtoul(name.c_str() + std::min<size_t>(name.size(), 5), nullptr, 10);
    for (unsigned long n = number + 1; !device.empty() && n <= number + kFar; ++n) {
        const std::string next = "video" + std::to_string(n);
        if (deviceOf(next) == device) {
            const fs::path file = video.parent_path() / next;
            return isMetadataNode(file) ? file : fs::path();
        }
    }
    return {};
}

} // namespace

std::optional<double> pipeLatencyOf(std::span<const uint8_t> buffer) {
    constexpr size_t kStamp = 10, kCaptureTiming = 40; // bytes: the driver's header; the metadata block
    constexpr uint32_t kTiming = 0x80000001u, kHasLatency = 0x20;
    constexpr uint8_t kPts = 0x04, kScr = 0x08; // stamps in the payload header
    if (buffer.size() < kStamp + 2) {
        return std::nullopt;
    }
    const size_t end = kStamp + buffer[kStamp]; // that byte is the header length, including itself
    const uint8_t flags = buffer[kStamp + 1];
    size_t at = kStamp + 2 + ((flags & kPts) != 0 ? 4 : 0) + ((flags & kScr) != 0 ? 6 : 0);
    if (end > buffer.size()) {
        return std::nullopt;
    }
    while (at + 8 <= end) {
        const size_t size = littleEndianWord(buffer, at + 4);
        if (size < 8 || size > end - at) {
            return std::nullopt;
        }
        if (littleEndianWord(buffer, at) == kTiming && size >= kCaptureTiming) {
            const uint32_t micros = littleEndianWord(buffer, at + 36);
            const bool reported =
                (littleEndianWord(buffer, at + 12) & kHasLatency) != 0 && micros > 0 && micros < 1000000;
            return reported ? std::optional(1e-6 * micros) : std::nullopt;
        }
        at += size;
    }
    return std::nullopt;
}

std::unique_ptr<MetadataStream> MetadataStream::openFor(const VideoNode& video) {
    const fs::path file = metadataNodeOf(video.file());
    const int descriptor = file.empty() ? -1 : ::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        return nullptr;
    }
    std::unique_ptr<MetadataStream> stream(new MetadataStream(descriptor));
    return stream->start() ? std::move(stream) : nullptr;
}

bool MetadataStream::start() {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_META_CAPTURE;
    format.fmt.meta.dataformat = V4L2_META_FMT_D4XX;
    if (videoIoctl(descriptor_, VIDIOC_S_FMT, &format) != 0 ||
        format.fmt.meta.dataformat != V4L2_META_FMT_D4XX) {
        return false;
    }
    v4l2_requestbuffers request{};
    request.count = kBuffers;
    request.type = V4L2_BUF_TYPE_META_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (videoIoctl(descriptor_, VIDIOC_REQBUFS, &request) != 0) {
        return false;
    }
    for (uint32_t i = 0; i < std::min(request.count, kBuffers); ++i) {
        v4l2_buffer buffer = metadataBuffer(i);
        if (videoIoctl(descriptor_, VIDIOC_QUERYBUF, &buffer) != 0) {
            return false;
        }
        void* at = ::mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, descriptor_,
                          static_cast<off_t>(buffer.m.offset));
        if (at == MAP_FAILED) {
            return false;
        }
        buffers_[i] = {static_cast<uint8_t*>(at), buffer.length};
        videoIoctl(descriptor_, VIDIOC_QBUF, &buffer);
    }
    int type = V4L2_BUF_TYPE_META_CAPTURE;
    return videoIoctl(descriptor_, VIDIOC_STREAMON, &type) == 0;
}

MetadataStream::~MetadataStream() {
    int type = V4L2_BUF_TYPE_META_CAPTURE;
    videoIoctl(descriptor_, VIDIOC_STREAMOFF, &type);
    for (const auto& buffer : buffers_) {
        if (!buffer.empty()) {
            ::munmap(buffer.data(), buffer.size());
        }
    }
    ::close(descriptor_);
}

void MetadataStream::gather() {
    v4l2_buffer buffer = metadataBuffer(0);
    while (videoIoctl(descriptor_, VIDIOC_DQBUF, &buffer) == 0) {
        const auto& bytes = buffers_[buffer.index];
        reported_[next_++ % reported_.size()] = {
            buffer.sequence,
            static_cast<double>(buffer.timestamp.tv_sec) +
                1e-6 * static_cast<double>(buffer.timestamp.tv_usec),
            pipeLatencyOf(bytes.first(std::min<size_t>(buffer.bytesused, bytes.size())))};
        videoIoctl(descriptor_, VIDIOC_QBUF, &buffer);
        buffer = metadataBuffer(0);
    }
}

std::optional<double> MetadataStream::exposureStart(uint32_t sequence, double stamp) {
    gather();
    const auto same = [=](const Reported& r) { // sequence numbers restart with the stream, stamps do not
        return r.sequence == sequence && std::abs(r.stamp - stamp) < 1e-4;
    };
    const auto found = std::find_if(reported_.begin(), reported_.end(), same);
    return found != reported_.end() && found->latency ? std::optional(stamp - *found->latency) : std::nullopt;
}

} // namespace fathom
