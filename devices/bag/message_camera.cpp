// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/message_camera.h"

#include "devices/bag/bag_motion.h"
#include "devices/recorded/set_back.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>

namespace fathom {

void MessageCamera::useSpan(const MessageTopic& topic) {
    depth_.emplace(*file_, topic);
    const auto place = [&](double after) {
        return static_cast<uint32_t>(after > 0.0 ? depth_->firstAfter(after) : 0);
    };
    const auto all = static_cast<uint32_t>(topic.messages.size());
    cursor_ = first_ = place(options_.start);
    end_ = std::isfinite(options_.duration) ? place(options_.start + options_.duration) : all;
    if (cursor_ >= end_) {
        const bool start = cursor_ >= all; // no duration would hold a frame
        throw BadInput(file_->file().string(), start ? "start" : "duration",
                       std::to_string(start ? options_.start : options_.duration),
                       start ? "a time before the last depth image" : "a time with at least one depth image");
    }
}

void MessageCamera::useClock(const MessageTopic& topic) {
    if (!depth_->stamped()) {
        log::warn("{}: {}: headers have no stamps: the time of recording is used", file_->file().string(),
                  topic.name);
    } else if (!stampsRise()) {
        log::warn("{}: {}: at least half of its stamps do not rise: the time of recording is used",
                  file_->file().string(), topic.name);
        depth_->useRecordingTime();
    } else if (const std::string fault = depth_->whyNoSeconds(); !fault.empty()) {
        warnOnce(topic.name, "its stamps are no seconds: " + fault + ": the time of recording is used");
        depth_->useRecordingTime();
    }
}

// Single stamps that go back are faults of frames. Where half of them do not rise, they are no times: all are
// equal, or each is the time since the frame before.
bool MessageCamera::stampsRise() {
    constexpr uint32_t kLooked = 30; // frames, so that a long recording is not read in advance
    const uint32_t last = std::min(end_, cursor_ + kLooked);
    double latest = -HUGE_VAL;
    uint32_t still = 0;
    for (uint32_t i = cursor_; i < last; ++i) {
        const double stamp = depth_->stampOf(i);
        still += stamp <= latest ? 1 : 0;
        latest = std::isfinite(stamp) ? std::max(latest, stamp) : latest;
    }
    return 2 * still < std::max(3u, last - cursor_);
}

void MessageCamera::addWarning(const std::string& warning) {
    if (!warning.empty()) {
        warnings_.push_back(warning);
    }
}

void MessageCamera::warnOfMotion(const std::string& frame) {
    if (const std::string motion = cameraMotion(*file_, frame); !motion.empty()) {
        log::warn("{}: {}", file_->file().string(), motion);
        addWarning(motion);
    }
}

void MessageCamera::warnBeyond(size_t index, uint64_t beyond) {
    const double limit = 65535.0 * info().metresPerUnit;
    if (beyond > 0 && !warnedBeyond_ && limit < options_.farthest) {
        warnedBeyond_ = true;
        log::warn("{}: frame {}: {} pixels are farther than {} m and count as not measured",
                  file_->file().string(), index, beyond, limit);
    }
}

void MessageCamera::warnOnce(const std::string& subject, const std::string& fault) {
    const std::string warning = subject + ": " + fault;
    if (!fault.empty() && std::ranges::find(warnings_, warning) == warnings_.end()) {
        log::warn("{}: {}", file_->file().string(), warning);
        addWarning(warning);
    }
}

std::optional<bool> MessageCamera::orderInstead(const std::string& topic,
                                                const std::function<Judged(size_t)>& judge) {
    constexpr size_t kSamples = 9;
    Judged first;
    sample(kSamples, [&](size_t i) {
        try {
            first = first.order == ByteOrder::Unknown ? judge(i) : first;
        } catch (const Error&) { // named when it is played
        }
    });
    if (first.order != ByteOrder::Swapped) {
        return std::nullopt;
    }
    warnOnce(topic, wrongOrder(first.bigEndian));
    return !first.bigEndian;
}

bool MessageCamera::seek(uint32_t index) {
    if (index >= end_) {
        return false;
    }
    cursor_ = index;
    lastStamp_.reset();
    shift_ = 0.0;
    return true;
}

// Frames continue one period after the last one.
void MessageCamera::followClock(uint32_t index, double stamp) {
    const auto stampOf = [this](size_t i) { return depth_->stampOf(i); };
    if (!lastStamp_ || stamp >= *lastStamp_ || !isSetBack(*lastStamp_, index, end_, stampOf)) {
        return;
    }
    if (index >= setBack_) { // not named before a seek()
        setBack_ = index + 1;
        const std::string warning = "the clock of depth goes back by " + std::to_string(*lastStamp_ - stamp) +
                                    " s at frame " + std::to_string(index) + ": times continue from there";
        log::warn("{}: {}", file_->file().string(), warning);
        addWarning(warning);
    }
    shift_ += *lastStamp_ - stamp + depth_->period();
    lastStamp_.reset();
}

std::string MessageCamera::faultOf(size_t index, FrameSlot& slot, double stamp, Frame::Content& content) {
    if (lastStamp_ && stamp < *lastStamp_) {
        return "depth stamp " + std::to_string(stamp) + " goes back from " + std::to_string(*lastStamp_);
    }
    try {
        return read(index, slot, stamp, content);
    } catch (const Error& e) {
        return e.what();
    }
}

std::optional<Frame> MessageCamera::next() {
    FrameSlot* slot = &slots_->acquireFor(description());
    while (cursor_ < end_) {
        const uint32_t index = cursor_++;
        const double stamp = depth_->stampOf(index);
        followClock(index, stamp);
        Frame::Content content;
        const std::string fault = faultOf(index, *slot, stamp, content);
        if (fault.empty()) {
            delivered_ = true;
            lastStamp_ = stamp;
            content.index = index;
            content.sourceNumber = index;
            content.captureTime = stamp + shift_;
            content.depth = slot->depth().first(info().depth.pixels());
            if (info().hasColour && !content.isRaw()) {
                content.colour = slot->colour().first(info().colour.pixels());
            }
            return slot->lend(content);
        }
        ++skipped_;
        firstFault_ = firstFault_.empty() ? fault : firstFault_;
        log::warn("{}: frame {} skipped: {}", file_->file().string(), index, fault);
    }
    slot->release();
    if (!delivered_) {
        throw BadInput(file_->file().string(), "frames", "none is usable; first: " + firstFault_,
                       "one usable frame");
    }
    return std::nullopt;
}

} // namespace fathom
