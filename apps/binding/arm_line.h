// SPDX-License-Identifier: Apache-2.0
// The connection to a real arm: a serial line, or topics of ROS 2.
#pragma once

#include "devices/arm.h"

#include <atomic>
#include <string>

namespace fathom {

// One thread.
class ArmLine {
public:
    virtual ~ArmLine() = default;
    virtual ArmDevice& device() noexcept = 0;
    // The line is unplugged; only a new one can be used.
    virtual bool gone() const noexcept = 0;
    // Waits until the arm may move. Throws Error: it cannot, or `stop`.
    virtual void awaitWatchdog(const std::atomic<bool>& stop) = 0;
    // True if a watchdog is ready to stop the arm, so it may move at time `now` [s]. Does not wait.
    virtual bool watched(double now) noexcept = 0;
    // [s] without feedback until the arm counts as absent at the start, and why it is silent, for messages.
    virtual double patience() const { return 5.0; }
    virtual std::string silence() const { return "no answer"; }
};

} // namespace fathom
