// SPDX-License-Identifier: Apache-2.0
// Turns the stamps of live messages, which any clock may have made, into capture times of this machine.
#pragma once

#include "devices/ros2/raw_message.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fathom {

// One topic, one thread.
class LiveStamps {
public:
    // topic: for log lines.
    explicit LiveStamps(std::string topic)
        : topic_(std::move(topic)) {}

    // The header's stamp [s]; of a header without one the arrival by UTC, with one warning.
    double stampOf(double header, const RawMessage& message);
    // Whether a message with that stamp [s] comes after the one before. After kMaxBackward earlier stamps,
    // none of them later, the clock was set back: the last of them counts, and restarted() is true once.
    // Equal stamps never count.
    bool forward(double stamp);
    bool restarted();
    // [s] CLOCK_MONOTONIC. The stamp counts once one was at most kOldest before this machine's UTC, so a
    // message that a network delays is old. Until then, after a restart, and ahead of UTC the arrival counts:
    // such stamps are of a simulation or of a machine with another clock. Never goes back.
    double captureTime(double stamp, const RawMessage& message);

    static constexpr uint32_t kMaxBackward = 5;
    static constexpr double kOldest = 1.0; // [s]

private:
    std::string topic_;
    std::optional<double> last_;
    uint32_t back_ = 0;
    bool restarted_ = false, agreed_ = false;
    bool byArrival_ = false, late_ = false, unstamped_ = false; // logged
    double lastCapture_ = 0.0;
};

} // namespace fathom
