// SPDX-License-Identifier: Apache-2.0
#include "engine/front/camera_port.h"

#include "engine/front/float_mode.h"
#include "engine/types/decimation.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fathom::v0 {

namespace {

bool aligned(const void* data, size_t to) {
    return data != nullptr && reinterpret_cast<uintptr_t>(data) % to == 0;
}

void requireImage(const std::string& place, const char* field, const void* data, size_t to) {
    if (!aligned(data, to)) {
        throw fathom::BadInput(place, field, data == nullptr ? "null" : "not aligned",
                               "an image aligned to " + std::to_string(to) + " bytes");
    }
}

void requirePose(const std::string& place, const char* field, const Pose& pose) {
    if (!isUsable(front::internal(pose))) {
        const auto& [x, y, z] = pose.position;
        const auto& [w, i, j, k] = pose.rotation;
        std::string value = "position";
        for (const double number : {x, y, z}) {
            value.append(1, ' ').append(significant(number, 6));
        }
        value += ", rotation";
        for (const double number : {w, i, j, k}) {
            value.append(1, ' ').append(significant(number, 6));
        }
        throw fathom::BadInput(place, field, value,
                               "a finite pose within 1000 km, whose quaternion is not zero");
    }
}

} // namespace

SubmitStatus CameraPort::Impl::checkStamp(const Frame& frame) const noexcept {
    if (frame.stamp <= 0) {
        return SubmitStatus::MissingStamp;
    }
    if (frame.stamp > now() + front::kMaxAhead) {
        return SubmitStatus::StampAhead;
    }
    return frame.stamp <= last ? SubmitStatus::StampBack : SubmitStatus::Accepted;
}

SubmitStatus CameraPort::Impl::checkImages(const Frame& frame) const noexcept {
    if (!aligned(frame.depth, depthAlignment()) ||
        (info.hasColour && !aligned(frame.colour, colourAlignment()))) {
        return SubmitStatus::MissingImage;
    }
    return isUsable(front::internal(frame.baseTcamera)) ? SubmitStatus::Accepted : SubmitStatus::BadPose;
}

// At least one is free: the others are at most waiting, taken and being processed. Borrowed frames
// use none.
CameraPort::Impl::UsedCopy CameraPort::Impl::unused() {
    for (;;) {
        for (Copy& copy : copies_) {
            if (!copy.used.load(std::memory_order_acquire)) {
                copy.used.store(true, std::memory_order_relaxed);
                return UsedCopy(&copy);
            }
        }
    }
}

void CameraPort::Impl::copyDepth(const Frame& frame, Copy& copy) const {
    copy.depth.resize(setup.delivered.depth.pixels());
    if (model.depthFormat == DepthFormat::Metres) {
        copyMetres(frame, copy);
    } else {
        std::memcpy(copy.depth.data(), frame.depth, copy.depth.size() * sizeof(uint16_t));
    }
    if (setup.decimation > 1) {
        decimate<uint16_t>(copy.depth, setup.delivered.depth, setup.decimation, copy.depth);
        copy.depth.resize(info.depth.pixels());
    }
    if (setup.correction) {
        setup.correction->apply(copy.depth, copy.depth);
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

std::span<const std::byte> CameraPort::Impl::colourOf(const Frame& frame) const {
    const CameraInfo& all = setup.delivered;
    return {static_cast<const std::byte*>(frame.colour), all.hasColour ? all.colourBytes() : 0};
}

void CameraPort::Impl::copyColour(const Frame& frame, Copy& copy) const {
    const CameraInfo& all = setup.delivered;
    const std::span<const std::byte> colour = colourOf(frame);
    if (setup.decimation == 1 || !all.hasColour || !all.registered) {
        copy.colour.assign(colour.begin(), colour.end());
        return;
    }
    copy.colour.resize(info.colourBytes());
    decimateColour({all.colourFormat, all.colour.width, all.colour.height, colour}, setup.decimation,
                   {reinterpret_cast<uint32_t*>(copy.colour.data()), info.colour.pixels()});
}

fathom::Frame CameraPort::Impl::contentOf(const Frame& frame, std::function<void()> release) {
    fathom::Frame::Content content;
    content.index = count_++;
    content.sourceNumber = content.index;
    content.captureTime = static_cast<double>(frame.stamp) * 1e-9;
    content.baseTcamera = front::internal(frame.baseTcamera);
    dquat& rotation = content.baseTcamera->rotation; // a unit quaternion stays the same to the last bit
    rotation = std::abs(glm::dot(rotation, rotation) - 1.0) < 1e-14 ? rotation : glm::normalize(rotation);
    content.raw = {info.colourFormat, info.colour.width, info.colour.height, {}};
    const bool converted =
        model.depthFormat == DepthFormat::Metres || setup.correction.has_value() || setup.decimation > 1;
    std::function<void()> onRelease;
    if (release && !converted) {
        content.depth = {static_cast<const uint16_t*>(frame.depth), info.depth.pixels()};
        content.setColourBytes(colourOf(frame));
        onRelease = std::move(release);
    } else {
        const fathom::Frame lent({}, std::move(release)); // given back once it is copied, or memory is short
        UsedCopy copy = unused();
        copyDepth(frame, *copy);
        copyColour(frame, *copy);
        content.depth = copy->depth;
        content.setColourBytes(copy->colour);
        onRelease = [used = copy.release()] { CopyRelease()(used); };
    }
    return fathom::Frame(content, std::move(onRelease));
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
    const std::string place = "camera " + model.name;
    requireImage(place, "frame.depth", frame.depth, depthAlignment());
    if (info.hasColour) {
        requireImage(place, "frame.colour", frame.colour, colourAlignment());
    }
    requirePose(place, "frame.baseTcamera", frame.baseTcamera);
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
    const front::FloatMode mode;
    return impl_->put(frame, nullptr);
}

SubmitStatus CameraPort::lend(const Frame& frame, std::function<void()> release) {
    const front::FloatMode mode;
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
