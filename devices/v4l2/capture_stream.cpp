// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/capture_stream.h"

#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <utility>

namespace fathom {

namespace {

v4l2_buffer bufferAt(uint32_t index) {
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
}

} // namespace

CaptureStream::CaptureStream(VideoNode node, const StreamRequest& request)
    : node_(std::move(node))
    , request_(request) {
    negotiate();
    setRate();
    map();
    for (uint32_t i = 0; i < kBuffers; ++i) {
        queue(i);
    }
    start();
}

CaptureStream::~CaptureStream() {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    node_.control(VIDIOC_STREAMOFF, &type);
}

void CaptureStream::fail(const char* what) const {
    if (errno == ENODEV || errno == EIO || errno == EPIPE || errno == EPROTO) {
        throw DeviceLost(node_.file().string() + ": " + what + ": " + std::strerror(errno));
    }
    throw BadInput(node_.file().string(), what, std::strerror(errno),
                   errno == EBUSY ? "a camera not in use by another program"
                                  : "a camera that streams its offered formats: " + node_.offer());
}

void CaptureStream::negotiate() {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    format.fmt.pix.width = request_.size.width;
    format.fmt.pix.height = request_.size.height;
    format.fmt.pix.pixelformat = request_.fourcc;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    if (node_.control(VIDIOC_S_FMT, &format) != 0) {
        fail("format");
    }
    const VideoSize got{format.fmt.pix.width, format.fmt.pix.height};
    if (format.fmt.pix.pixelformat != request_.fourcc || got != request_.size) {
        throw BadInput(node_.file().string(), "format",
                       fourccName(request_.fourcc) + " " + sizeName(request_.size), node_.offer());
    }
    stride_ = format.fmt.pix.bytesperline;
}

// An unsupported rate is not an error: the driver reports the rate that it chose.
void CaptureStream::setRate() {
    v4l2_streamparm parameters{};
    parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    parameters.parm.capture.timeperframe = {1000, static_cast<uint32_t>(std::lround(1000.0 * request_.rate))};
    period_ = 1.0 / request_.rate;
    if (node_.control(VIDIOC_S_PARM, &parameters) == 0) {
        const v4l2_fract took = parameters.parm.capture.timeperframe;
        if (took.numerator > 0 && took.denominator > 0) {
            period_ = static_cast<double>(took.numerator) / took.denominator;
        }
    }
}

void CaptureStream::map() {
    v4l2_requestbuffers request{};
    request.count = kBuffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (node_.control(VIDIOC_REQBUFS, &request) != 0) {
        fail("buffers");
    }
    if (request.count < kBuffers) {
        throw BadInput(node_.file().string(), "buffers", std::to_string(request.count),
                       std::to_string(kBuffers) + " or more");
    }
    for (uint32_t i = 0; i < kBuffers; ++i) {
        v4l2_buffer buffer = bufferAt(i);
        if (node_.control(VIDIOC_QUERYBUF, &buffer) != 0) {
            fail("buffers");
        }
        // Read and write: not every GPU driver can import read-only pages.
        void* at = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, node_.descriptor(),
                          static_cast<off_t>(buffer.m.offset));
        if (at == MAP_FAILED) {
            fail("buffers");
        }
        const size_t size = buffer.length;
        buffers_[i] = {std::shared_ptr<void>(at, [size](void* pages) { ::munmap(pages, size); }), size};
    }
}

bool CaptureStream::queue(uint32_t index) noexcept {
    v4l2_buffer buffer = bufferAt(index);
    const bool done = node_.control(VIDIOC_QBUF, &buffer) == 0;
    queued_ += done ? 1 : 0;
    return done;
}

void CaptureStream::start() {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (node_.control(VIDIOC_STREAMON, &type) != 0) {
        fail("streaming");
    }
}

void CaptureStream::restart() {
    const std::lock_guard lock(returning_);
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (node_.control(VIDIOC_STREAMOFF, &type) != 0) {
        throw DeviceLost(node_.file().string() + ": streaming: " + std::strerror(errno));
    }
    queued_ = 0;
    lastSequence_.reset();
    for (uint32_t i = 0; i < kBuffers; ++i) {
        if (!held_[i].load()) {
            queue(i);
        }
    }
    try {
        start();
    } catch (const BadInput& e) {
        throw DeviceLost(e.what());
    }
}

std::optional<CapturedBuffer> CaptureStream::take() {
    v4l2_buffer buffer = bufferAt(0);
    if (node_.control(VIDIOC_DQBUF, &buffer) != 0) {
        if (errno == EAGAIN || errno == EIO) { // EIO: the transfer of one frame failed
            return std::nullopt;
        }
        throw DeviceLost(node_.file().string() + ": " + std::strerror(errno));
    }
    --queued_;
    held_[buffer.index] = true;
    missing_ += lastSequence_ ? missingBetween(*lastSequence_, buffer.sequence) : 0;
    lastSequence_ = buffer.sequence;
    CapturedBuffer out;
    out.index = buffer.index;
    out.sequence = buffer.sequence;
    out.stamp = stampOf(buffer.timestamp.tv_sec, buffer.timestamp.tv_usec, buffer.flags);
    const Buffer& filled = buffers_[buffer.index];
    out.bytes = {static_cast<const std::byte*>(filled.pages.get()),
                 std::min<size_t>(buffer.bytesused, filled.size)};
    out.memory = filled.pages;
    out.damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
    return out;
}

double CaptureStream::stampOf(long seconds, long micros, uint32_t flags) {
    const double now = monotonicSeconds();
    if ((flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
        return now;
    }
    const double stamp = static_cast<double>(seconds) + 1e-6 * static_cast<double>(micros);
    const double usable = usableStamp(stamp, now);
    if (usable != stamp && !std::exchange(ahead_, true)) {
        log::warn("{}: a time stamp is {:.3f} s ahead: such frames are dated by their arrival (logged once)",
                  node_.file().string(), stamp - now);
    }
    return usable;
}

void CaptureStream::giveBack(uint32_t index) noexcept {
    const std::lock_guard lock(returning_);
    if (held_[index].exchange(false)) {
        queue(index);
    }
}

} // namespace fathom
