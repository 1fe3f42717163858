// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stamped_stream.h"

#include "devices/bag/ros_messages.h"
#include "engine/types/median.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr uint64_t kMaxDelay = 1'000'000'000; // [ns] between the recording of two images of one instant
constexpr size_t kMaxTried = 100;             // messages on either side
constexpr size_t kTriedByStamp = 8;           // likewise, around a place found by stamps

double secondsOf(uint64_t nanoseconds) {
    return 1e-9 * static_cast<double>(nanoseconds);
}

} // namespace

StampedStream::StampedStream(MessageFile& file, const MessageTopic& topic)
    : file_(file)
    , topic_(topic)
    , stamps_(topic.messages.size(), NAN) {
    constexpr size_t kTried = 3; // a simulator's clock begins at 0
    stamped_ = false;
    for (size_t i = 0; i < std::min(kTried, stamps_.size()) && !stamped_; ++i) {
        stamped_ = stampOf(i) != 0.0;
    }
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
    const auto middle = std::ranges::lower_bound(all, recordedAt, {}, &MessageEntry::time);
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
    if (searchesAll_) {
        const size_t found = firstFrom(stamp);
        for (size_t i = found - std::min(found, kTriedByStamp);
             i < std::min(all.size(), found + kTriedByStamp); ++i) {
            consider(i);
        }
        if (best) {
            return best;
        }
    }
    for (size_t i = from; i-- > from - std::min(from, kMaxTried) && apart(all[i].time) <= kMaxDelay;) {
        consider(i);
    }
    for (size_t i = from; i < std::min(all.size(), from + kMaxTried) && apart(all[i].time) <= kMaxDelay;
         ++i) {
        consider(i);
    }
    return best;
}

// The first message of a stamp from this one on, where stamps rise.
size_t StampedStream::firstFrom(double stamp) {
    size_t low = 0, high = stamps_.size();
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        size_t probe = middle;
        while (probe < high && !std::isfinite(stampOf(probe))) {
            ++probe; // damaged
        }
        if (probe < high && stampOf(probe) < stamp) {
            low = probe + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

double StampedStream::recordedPeriod() const {
    std::vector<double> steps;
    for (size_t i = 1; i < topic_.messages.size(); ++i) {
        steps.push_back(secondsOf(topic_.messages[i].time - topic_.messages[i - 1].time));
    }
    return steps.empty() ? 0.0 : medianOf(steps);
}

// By a few places of a long file.
const StampedStream::Rise& StampedStream::rise() {
    constexpr size_t kPlaces = 4, kSteps = 8, kFewest = 3;
    if (rise_) {
        return *rise_;
    }
    rise_ = Rise{0.0, 0.0};
    const size_t last = stamps_.size() - 1;
    const bool isLong = last > kPlaces * kSteps;
    std::vector<double> steps, seen;
    size_t still = 0;
    for (size_t place = 0; place < (isLong ? kPlaces : 1); ++place) {
        const size_t from = isLong ? place * (last - kSteps) / (kPlaces - 1) : 0;
        double before = NAN;
        for (size_t i = from; i <= (isLong ? from + kSteps : last); ++i) {
            const double stamp = stampOf(i);
            if (!std::isfinite(stamp)) {
                continue;
            }
            seen.push_back(stamp);
            if (stamp > before) {
                steps.push_back(stamp - before);
            } else {
                still += std::isnan(before) ? 0 : 1;
            }
            before = stamp;
        }
    }
    if (stamped_ && steps.size() >= kFewest && still < steps.size()) {
        rise_ = Rise{medianOf(steps), seen.back() - seen.front()};
    }
    return *rise_;
}

double StampedStream::period() {
    constexpr double kAlike = 1.25;
    const double recorded = recordedPeriod(), stamped = stamped_ ? rise().period : 0.0;
    const bool alike = recorded <= kAlike * stamped && stamped <= kAlike * recorded;
    return stamped > 0.0 && !alike ? stamped : recorded;
}

bool StampedStream::recordedInTime() {
    constexpr double kMinApart = 1.0, kMaxApart = 0.05; // [s], of the span
    constexpr double kShortest = 1e-4, kLongest = 10.0; // [s] periods of a camera
    constexpr double kAlike = 1.1;
    if (!stamped_ || rise().span <= 0.0 || rise().period < kShortest || rise().period > kLongest) {
        return true;
    }
    const auto [period, span] = rise();
    const double recorded = secondsOf(topic_.messages.back().time - topic_.messages.front().time);
    if (std::abs(recorded - span) <= std::max(kMinApart, kMaxApart * span)) {
        return true;
    }
    const double step = recordedPeriod(); // alike: the clock of the stamps was set forward or back
    return step <= kAlike * period && period <= kAlike * step;
}

std::string StampedStream::whyNoSeconds() {
    constexpr double kShortest = 1e-3, kLongest = 0.5; // [s] recorded periods of a camera
    constexpr double kMax = 10.0, kMin = 2e-4;         // [s] stamped ones
    const double recorded = recordedPeriod(), stamped = stamped_ ? rise().period : 0.0;
    if (stamped <= 0.0 || recorded < kShortest || recorded > kLongest) {
        return "";
    }
    const bool counted = stamped == 1.0 && stampOf(0) == std::round(stampOf(0)) && stampOf(0) < 1e6;
    if (!counted && stamped >= kMin && stamped <= kMax) {
        return "";
    }
    return counted ? "they count frames, which were recorded every " + significant(recorded, 3) + " s"
                   : "images " + significant(stamped, 3) + " apart were recorded every " +
                         significant(recorded, 3) + " s";
}

size_t StampedStream::firstAfter(double seconds) {
    const std::vector<MessageEntry>& all = topic_.messages;
    if (!recordedInTime()) {
        const auto first = std::ranges::find_if(stamps_, [](double stamp) { return std::isfinite(stamp); });
        return firstFrom(*first + seconds);
    }
    const auto at = std::ranges::find_if(
        all, [&](const MessageEntry& entry) { return secondsOf(entry.time - all.front().time) >= seconds; });
    return static_cast<size_t>(at - all.begin());
}

bool StampedStream::hasRecorded(uint64_t time, double within) const {
    const std::vector<MessageEntry>& all = topic_.messages;
    const auto next = std::ranges::lower_bound(all, time, {}, &MessageEntry::time);
    return (next != all.end() && secondsOf(next->time - time) <= within) ||
           (next != all.begin() && secondsOf(time - (next - 1)->time) <= within);
}

} // namespace fathom
