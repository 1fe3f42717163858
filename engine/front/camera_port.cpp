// SPDX-License-Identifier: Apache-2.0
#include "engine/front/camera_port.h"

#include "engine/types/decimation.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fathom::v0 {

namespace {

bool aligned(const void* data, size_t to) {
    return data != nullptr && reinterpret_cast<uintptr_t>(data) % to == 0;
}

} // namespace

SubmitStatus CameraPort::Impl::checkStamp(const Frame& frame) const noexcept {
    if (frame.stamp <= 0) {
        return SubmitStatus::MissingStamp;
    }
    if (frame.stamp > now() + front::kMostAhead) {
        return SubmitStatus::StampAhead;
    }
    return frame.stamp <= last ? SubmitStatus::StampBack : SubmitStatus::Accepted;
}

SubmitStatus CameraPort::Impl::checkImages(const Frame& frame) const noexcept {
    const bool rgb = model.colourFormat == ColourFormat::Rgb;
    const size_t depthSize = model.depthFormat == DepthFormat::Metres ? sizeof(float) : sizeof(uint16_t);
    if (!aligned(frame.depth, depthSize) || (info.hasColour && !aligned(frame.colour, rgb ? 1 : 4))) {
        return SubmitStatus::MissingImage;
    }
    return isFinite(front::internal(frame.baseTcamera)) ? SubmitStatus::Accepted : SubmitStatus::BadPose;
}

// At least one is free: the others are at most waiting, taken, uploaded and on the device. Borrowed frames
// use none.
CameraPort::Impl::Copy& CameraPort::Impl::unused() {
    for (;;) {
        for (Copy& copy : copies_) {
            if (!copy.used.load(std::memory_order_acquire)) {
                copy.used.store(true, std::memory_order_relaxed);
                return copy;
            }
        }
    }
}

void CameraPort::Impl::copyDepth(const Frame& frame, Copy& copy) const {
    copy.depth.resize(side.delivered.depth.pixels());
    if (model.depthFormat == DepthFormat::Metres) {
        copyMetres(frame, copy);
    } else {
        std::memcpy(copy.depth.data(), frame.depth, copy.depth.size() * sizeof(uint16_t));
    }
    if (side.decimation > 1) {
        decimate<uint16_t>(copy.depth, side.delivered.depth, side.decimation, copy.depth);
        copy.depth.resize(info.depth.pixels());
    }
    if (side.correction) {
        side.correction->apply(copy.depth, copy.depth);
    }
}

void CameraPort::Impl::copyMetres(const Frame& frame, Copy& copy) const {
    const auto* metres = static_cast<const float*>(frame.depth);
    const auto perMetre = static_cast<float>(1.0 / info.metresPerUnit);
    for (size_t i = 0; i < copy.depth.size(); ++i) {
        const float units = metres[i] * perMetre + 0.5f;
        copy.depth[i] = units >= 1.0f && units < 65536.0f ? static_cast<uint16_t>(units) : uint16_t{0};
    }
}

void CameraPort::Impl::copyColour(const Frame& frame, Copy& copy) const {
    const CameraInfo& all = side.delivered;
    copy.colour.resize(all.hasColour ? all.colourBytes() / sizeof(uint32_t) : 0);
    if (model.colourFormat == ColourFormat::Rgb) {
        copyRgb(frame, copy);
    } else if (all.hasColour) {
        std::memcpy(copy.colour.data(), frame.colour, copy.colour.size() * sizeof(uint32_t));
    }
    if (side.decimation > 1 && all.hasColour && all.registered) {
        if (all.yuyv) {
            decimateYuyv(copy.colour, all.colour, side.decimation, copy.colour);
        } else {
            decimate<uint32_t>(copy.colour, all.colour, side.decimation, copy.colour);
        }
        copy.colour.resize(info.colour.pixels());
    }
}

void CameraPort::Impl::copyRgb(const Frame& frame, Copy& copy) const {
    const auto* bytes = static_cast<const uint8_t*>(frame.colour);
    for (size_t i = 0; i < copy.colour.size(); ++i) {
        const uint8_t* rgb = bytes + 3 * i;
        copy.colour[i] = 0xff000000u | uint32_t{rgb[2]} << 16 | uint32_t{rgb[1]} << 8 | rgb[0];
    }
}

fathom::Frame CameraPort::Impl::contentOf(const Frame& frame, std::function<void()> release) {
    fathom::Frame::Content content;
    content.index = count_++;
    content.sourceNumber = content.index;
    content.captureTime = static_cast<double>(frame.stamp) * 1e-9;
    content.baseTcamera = front::internal(frame.baseTcamera);
    dquat& rotation = content.baseTcamera->rotation; // a unit quaternion stays the same to the last bit
    rotation = std::abs(glm::dot(rotation, rotation) - 1.0) < 1e-14 ? rotation : glm::normalize(rotation);
    const bool converted = model.depthFormat == DepthFormat::Metres ||
                           model.colourFormat == ColourFormat::Rgb || side.correction.has_value() ||
                           side.decimation > 1;
    std::span<const uint32_t> colour;
    std::function<void()> giveBack;
    if (release && !converted) {
        content.depth = {static_cast<const uint16_t*>(frame.depth), info.depth.pixels()};
        if (info.hasColour) {
            colour = {static_cast<const uint32_t*>(frame.colour), info.colourBytes() / sizeof(uint32_t)};
        }
        giveBack = std::move(release);
    } else {
        Copy& copy = unused();
        copyDepth(frame, copy);
        copyColour(frame, copy);
        if (release) {
            release();
        }
        content.depth = copy.depth;
        colour = copy.colour;
        giveBack = [&copy] { copy.used.store(false, std::memory_order_release); };
    }
    (info.yuyv ? content.yuyv : content.colour) = colour;
    return fathom::Frame(content, std::move(giveBack));
}

SubmitStatus CameraPort::Impl::put(const Frame& frame, std::function<void()> release) {
    SubmitStatus status = checkStamp(frame);
    status = status == SubmitStatus::Accepted ? checkImages(frame) : status;
    if (status != SubmitStatus::Accepted) {
        if (release) {
            release();
        }
        return status;
    }
    std::optional<fathom::Frame> next = contentOf(frame, std::move(release));
    {
        const std::lock_guard lock(mutex_);
        if (closed_) {
            return SubmitStatus::Closed; // `next` is released outside the lock
        }
        std::swap(waiting_, next);
    }
    last = frame.stamp;
    dropped += next ? 1 : 0;
    changed_.notify_one();
    return SubmitStatus::Accepted;
}

fathom::Frame CameraPort::Impl::copy(const Frame& frame) {
    const SubmitStatus status = checkImages(frame);
    if (status != SubmitStatus::Accepted) {
        throw BadInput(std::string("frame: ") +
                       (status == SubmitStatus::BadPose ? "baseTcamera" : "depth or colour") +
                       " (allowed: images of the camera's formats and a finite pose)");
    }
    return contentOf(frame, nullptr);
}

std::optional<fathom::Frame> CameraPort::Impl::take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || waiting_.has_value(); });
    return std::exchange(waiting_, std::nullopt);
}

void CameraPort::Impl::close() {
    std::optional<fathom::Frame> unwanted; // released outside the lock
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        std::swap(waiting_, unwanted);
    }
    changed_.notify_all();
}

CameraPort::CameraPort(std::shared_ptr<Impl> impl) noexcept
    : impl_(std::move(impl)) {}

SubmitStatus CameraPort::submit(const Frame& frame) {
    return impl_->put(frame, nullptr);
}

SubmitStatus CameraPort::lend(const Frame& frame, std::function<void()> release) {
    return impl_->put(frame, std::move(release));
}

void CameraPort::clockJumped() noexcept {
    impl_->last = 0;
}

std::uint64_t CameraPort::dropped() const noexcept {
    return impl_->dropped.load();
}

std::uint64_t CameraPort::processed() const noexcept {
    return impl_->processed.load();
}

} // namespace fathom::v0
