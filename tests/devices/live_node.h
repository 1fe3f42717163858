// SPDX-License-Identifier: Apache-2.0
// Messages as they arrive from a node of ROS 2, without a network.
#pragma once

#include "devices/bag/ros2_messages.h"
#include "devices/ros2/ros2_graph.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace fathom::testing {

// Times [s] count from the beginning of the test.
struct LiveNode {
    static constexpr double kUtc = 1.7e9, kBoot = 1000.0; // [s] of both clocks at the beginning

    uint64_t id = 1; // of the publisher

    static uint64_t nanoseconds(double stamp) {
        return static_cast<uint64_t>(std::llround((kUtc + stamp) * 1e9));
    }
    Ros2Message sends(const ros2::Message& bytes, double arrival) const {
        auto message = std::make_shared<RawMessage>();
        message->memory.reset(new uint8_t[bytes.size() + 4]());
        std::copy(bytes.begin(), bytes.end(), message->memory.get());
        message->size = static_cast<uint32_t>(bytes.size());
        message->arrival = kBoot + arrival;
        message->arrivalUtc = kUtc + arrival;
        return {message, id};
    }
};

} // namespace fathom::testing
