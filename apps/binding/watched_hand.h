// SPDX-License-Identifier: Apache-2.0
// A live hand whose loss and return another thread reports.
#pragma once

#include "devices/live_hand.h"

#include <atomic>

namespace fathom {

// read() and write(): haptic thread. change(): one other thread.
class WatchedHand final : public HapticDevice {
public:
    // `hand` outlives this and is connected now.
    explicit WatchedHand(LiveHand& hand)
        : hand_(hand)
        , name_(hand.description()) {}

    HandSample read(double t) noexcept override {
        const HandSample sample = hand_.read(t);
        present_.store(hand_.alive(), std::memory_order_relaxed);
        return sample;
    }
    void write(const Wrench& deviceWrench, double dt) noexcept override { hand_.write(deviceWrench, dt); }

    // One log line per change, else empty. A loss and return between two calls is only counted
    // (LiveHandFigures::losses).
    std::string change() {
        const bool present = present_.load(std::memory_order_relaxed);
        if (present == reported_) {
            return "";
        }
        reported_ = present;
        return name_ + (present ? ": back; the tool resumes from its position"
                                : ": gone or silent: forces fade out, the tool stays; reconnecting");
    }

private:
    LiveHand& hand_;
    std::string name_; // a copy, because the haptic thread may change the device's own
    std::atomic<bool> present_{true};
    bool reported_ = true;
};

} // namespace fathom
