// SPDX-License-Identifier: Apache-2.0
// Chooses among several publishers of one topic.
#pragma once

#include "devices/ros2/ros2_graph.h"

#include <cstdint>
#include <string>

namespace fathom {

// The first publisher that sends owns the topic until it is silent for kSilence. One thread.
class FirstPublisher {
public:
    // reader, topic: for the log, which names a second publisher once.
    FirstPublisher(std::string reader, std::string topic)
        : reader_(std::move(reader))
        , topic_(std::move(topic)) {}

    // Whether the message is from the publisher that has the topic.
    bool accepts(const Ros2Message& message);
    uint64_t foreign() const { return foreign_; } // messages that were not accepted

    static constexpr double kSilence = 1.0; // [s]

private:
    std::string reader_, topic_;
    uint64_t publisher_ = 0; // 0 = none yet
    double heard_ = 0.0;     // [s] CLOCK_MONOTONIC, its last message
    uint64_t foreign_ = 0;
};

} // namespace fathom
