// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_camera.h"

#include "devices/bag/image_faults.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kLongestWait = 0.1; // [s]
constexpr double kPoseWait = 0.02;   // [s] while images wait for transforms

} // namespace

ros::Image Ros2Camera::imageOf(const ImageStream& stream, const RawMessage& message) const {
    const MessageCursor cursor(message.bytes(), true);
    return stream.compressed ? ros::compressedImage(cursor) : ros::image(cursor);
}

void Ros2Camera::skip(const std::string& fault, uint32_t frames) {
    skipped_.add(description(), fault, frames);
}

void Ros2Camera::receive(Topic& topic, const ImageStream& stream, LiveStamps& stamps, bool depth) {
    for (const Ros2Message& taken : inbox_.take(topic.place)) {
        if (!topic.publisher->accepts(taken)) {
            continue;
        }
        try {
            const double stamp =
                stamps.stampOf(ros::stamp(MessageCursor(taken.message->bytes(), true)), *taken.message);
            if (!stamps.forward(stamp)) {
                skip(stream.name + ": a stamp is not later than the one before", depth ? 1 : 0);
                continue;
            }
            if (depth && stamps.restarted()) {
                pairs_->clear();
                moving_ ? moving_->clear() : void();
            }
            depth ? pairs_->depth({stamp, taken.message}) : pairs_->colour({stamp, taken.message});
            lastDepth_ = depth ? taken.message->arrival : lastDepth_;
        } catch (const Error& e) {
            skip(stream.name + ": " + e.what(), depth ? 1 : 0);
        }
    }
}

void Ros2Camera::receiveTransforms() {
    for (const auto& [topic, isStatic] : {std::pair(tfStatic_, true), std::pair(tf_, false)}) {
        for (auto taken = inbox_.take(topic); !taken.empty(); taken = inbox_.take(topic)) {
            for (const Ros2Message& message : taken) {
                moving_->transforms().take(message, isStatic);
            }
        }
    }
}

// Transforms and colour first: they may be what a depth image waits for.
void Ros2Camera::receive() {
    if (moving_) {
        receiveTransforms();
    }
    if (choice_.colour) {
        receive(colour_, *choice_.colour, *colourStamps_, false);
    }
    receive(depth_, choice_.depth, *depthStamps_, true);
}

std::string Ros2Camera::fillDepth(const RawMessage& message, FrameSlot& slot) {
    ros::Image image = imageOf(choice_.depth, message);
    image.bigEndian = bigEndian_.value_or(image.bigEndian);
    if (const std::string other = depthFault(choice_.depth, image, info()); !other.empty()) {
        return other;
    }
    uint64_t beyond = 0;
    const std::string fault = ros::depthRows(image, valuesPerUnit_, slot.depth(), beyond);
    const double limit = 65535.0 * info().metresPerUnit;
    if (fault.empty() && beyond > 0 && limit < request_.options.farthest) {
        skip(choice_.depth.name + ": pixels farther than " + std::to_string(limit) +
                 " m count as not measured",
             0);
    }
    toAxis_.convert(slot.depth());
    return fault;
}

std::string Ros2Camera::fillColour(const RawMessage& message, FrameSlot& slot, RawColour& raw) {
    const ros::Image image = imageOf(*choice_.colour, message);
    const std::string other = colourFault(*choice_.colour, image, info());
    return other.empty() ? ros::colourRows(image, slot.colour(), raw) : other;
}

// Returns the fault; empty when the slot is filled.
std::string Ros2Camera::fill(const LivePairs::Pair& pair, FrameSlot& slot, RawColour& raw) {
    const auto named = [](const std::string& topic, const std::string& fault) {
        return fault.empty() ? "" : topic + ": " + fault;
    };
    const std::string* topic = &choice_.depth.name;
    try {
        const std::string fault = named(*topic, fillDepth(*pair.depth.message, slot));
        if (!fault.empty() || !pair.colour) {
            return fault;
        }
        topic = &choice_.colour->name;
        return named(*topic, fillColour(*pair.colour->message, slot, raw));
    } catch (const Error& e) {
        return named(*topic, e.what());
    }
}

std::optional<MovingCamera::Posed> Ros2Camera::nextPosed(double now) {
    while (std::optional<LivePairs::Pair> pair = pairs_->next(now)) {
        if (!moving_) {
            return MovingCamera::Posed{std::move(*pair), std::nullopt, ""};
        }
        moving_->add(std::move(*pair));
    }
    while (std::optional<MovingCamera::Posed> posed = moving_ ? moving_->next(now) : std::nullopt) {
        if (posed->fault.empty()) {
            return posed;
        }
        skip(choice_.depth.name + ": " + posed->fault);
    }
    return std::nullopt;
}

// The next images, or the newest of those that are ready.
std::optional<MovingCamera::Posed> Ros2Camera::choose(double now) {
    std::optional<MovingCamera::Posed> chosen = nextPosed(now);
    while (chosen && !request_.everyFrame) {
        std::optional<MovingCamera::Posed> newer = nextPosed(now);
        if (!newer) {
            break;
        }
        ++overtaken_;
        chosen = std::move(newer);
    }
    return chosen;
}

std::optional<Frame> Ros2Camera::deliver() {
    const std::optional<MovingCamera::Posed> chosen = choose(monotonicSeconds());
    if (const size_t unpaired = pairs_->takeUnpaired()) {
        skip(choice_.depth.name + ": no colour image with a stamp that near",
             static_cast<uint32_t>(unpaired));
    }
    if (!chosen) {
        return std::nullopt;
    }
    const LivePairs::Pair& pair = chosen->pair;
    FrameSlot* slot = &slots_->acquireFor(description());
    Frame::Content content;
    if (const std::string fault = fill(pair, *slot, content.raw); !fault.empty()) {
        slot->release();
        skip(fault);
        return std::nullopt;
    }
    content.index = delivered_++;
    content.sourceNumber = delivered_;
    content.captureTime = depthStamps_->captureTime(pair.depth.stamp, *pair.depth.message);
    content.baseTcamera = chosen->fixedTcamera;
    content.depth = slot->depth().first(info().depth.pixels());
    if (info().hasColour && !content.isRaw()) {
        content.colour = slot->colour().first(info().colour.pixels());
    }
    return slot->lend(content);
}

std::optional<Frame> Ros2Camera::next() {
    const double called = monotonicSeconds();
    for (;;) {
        receive();
        if (std::optional<Frame> frame = deliver()) {
            return frame;
        }
        const double now = monotonicSeconds();
        if (now - std::max(lastDepth_, called - 0.5 * request_.silence) > request_.silence) {
            throw DeviceLost(description() + ": no depth image for " + std::to_string(now - lastDepth_) +
                             " s");
        }
        if (now - called > request_.silence) {
            skipped_.fail(description());
        }
        inbox_.wait(pairs_->patience(now, moving_ && moving_->waits() ? kPoseWait : kLongestWait));
    }
}

} // namespace fathom
