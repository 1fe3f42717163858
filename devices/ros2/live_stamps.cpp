// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/live_stamps.h"

#include "engine/types/log.h"

#include <algorithm>
#include <utility>

namespace fathom {

double LiveStamps::stampOf(double header, const RawMessage& message) {
    if (header != 0.0) {
        return header;
    }
    if (!unstamped_) {
        log::warn("ros2:{}: headers have no stamps: the time of arrival is used", topic_);
        unstamped_ = true;
    }
    return message.arrivalUtc;
}

bool LiveStamps::forward(double stamp) {
    if (last_ && stamp == *last_) { // the node repeats itself, or its clock stands still
        return false;
    }
    if (last_ && stamp <= *last_ && ++back_ < kMaxBackward) {
        return false;
    }
    if (back_ >= kMaxBackward) {
        log::warn("ros2:{}: its clock was set back by {:.3f} s", topic_, *last_ - stamp);
        restarted_ = true;
        agreed_ = false;
    }
    back_ = 0;
    last_ = stamp;
    return true;
}

bool LiveStamps::restarted() {
    return std::exchange(restarted_, false);
}

double LiveStamps::captureTime(double stamp, const RawMessage& message) {
    constexpr double kAhead = 0.005; // [s] by which clocks of machines in step may differ
    const double age = message.arrivalUtc - stamp;
    agreed_ = agreed_ || (age >= -kAhead && age <= kOldest);
    const bool byStamp = agreed_ && age >= -kAhead;
    if (!byStamp && !byArrival_) {
        log::warn("ros2:{}: a stamp is {:.3f} s from this machine's clock: such messages are dated by their "
                  "arrival",
                  topic_, -age);
        byArrival_ = true;
    }
    if (byStamp && age > kOldest && !late_) {
        log::warn("ros2:{}: a message came {:.3f} s after its stamp (logged once)", topic_, age);
        late_ = true;
    }
    const double capture = byStamp ? message.arrival - std::max(age, 0.0) : message.arrival;
    lastCapture_ = std::max(lastCapture_, capture);
    return lastCapture_;
}

} // namespace fathom
