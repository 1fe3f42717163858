// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/first_publisher.h"

#include "engine/types/log.h"

namespace fathom {

bool FirstPublisher::accepts(const Ros2Message& message) {
    const double now = message.message->arrival;
    if (publisher_ == 0 || (publisher_ != message.publisher && now > heard_ + kSilence)) {
        publisher_ = message.publisher;
    }
    if (publisher_ != message.publisher) {
        if (foreign_++ == 0) {
            log::warn("{}: {} has a second publisher, whose messages are ignored", reader_, topic_);
        }
        return false;
    }
    heard_ = now;
    return true;
}

} // namespace fathom
