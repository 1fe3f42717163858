// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stamped_stream.h"

#include "devices/bag/ros_messages.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr uint64_t kMaxDelay = 1'000'000'000; // [ns] between the recording of two images of one instant
constexpr size_t kMaxTried = 100;             // messages on either side

double secondsOf(uint64_t nanoseconds) {
    return 1e-9 * static_cast<double>(nanoseconds);
}

} // namespace

StampedStream::StampedStream(MessageFile& file, const MessageTopic& topic)
    : file_(file)
    , topic_(topic)
    , stamps_(topic.messages.size(), NAN) {
    stamped_ = stampOf(0) != 0.0;
    if (!stamped_) {
        useRecordingTime();
    }
}

void StampedStream::useRecordingTime() {
    stamped_ = false;
    std::transform(topic_.messages.begin(), topic_.messages.end(), stamps_.begin(),
                   [](const MessageEntry& entry) { return secondsOf(entry.time); });
}

double StampedStream::stampOf(size_t index) {
    if (std::isnan(stamps_[index])) {
        try {
            stamps_[index] = ros::stamp(file_.read(topic_, index));
        } catch (const Error&) {
            stamps_[index] = HUGE_VAL; // damaged: near to nothing
        }
    }
    return stamps_[index];
}

std::optional<size_t> StampedStream::nearest(double stamp, uint64_t recordedAt, double within) {
    const std::vector<MessageEntry>& all = topic_.messages;
    const auto apart = [recordedAt](uint64_t time) {
        return time > recordedAt ? time - recordedAt : recordedAt - time;
    };
    const auto middle = std::lower_bound(all.begin(), all.end(), recordedAt,
                                         [](const MessageEntry& e, uint64_t t) { return e.time < t; });
    const auto from = static_cast<size_t>(middle - all.begin());
    std::optional<size_t> best;
    double least = within;
    const auto consider = [&](size_t index) {
        const double distance = std::abs(stampOf(index) - stamp);
        const bool closer = best && apart(all[index].time) < apart(all[*best].time);
        if (distance < least || (distance <= least && (!best || closer))) {
            least = distance;
            best = index;
        }
    };
    for (size_t i = from; i-- > from - std::min(from, kMaxTried) && apart(all[i].time) <= kMaxDelay;) {
        consider(i);
    }
    for (size_t i = from; i < std::min(all.size(), from + kMaxTried) && apart(all[i].time) <= kMaxDelay;
         ++i) {
        consider(i);
    }
    return best;
}

double StampedStream::medianPeriod() const {
    std::vector<uint64_t> steps;
    for (size_t i = 1; i < topic_.messages.size(); ++i) {
        steps.push_back(topic_.messages[i].time - topic_.messages[i - 1].time);
    }
    if (steps.empty()) {
        return 0.0;
    }
    std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
    return secondsOf(steps[steps.size() / 2]);
}

} // namespace fathom
