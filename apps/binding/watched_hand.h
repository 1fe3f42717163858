// SPDX-License-Identifier: Apache-2.0
// A live hand whose going and coming back another thread tells of.
#pragma once

#include "devices/live_hand.h"

#include <atomic>

namespace fathom {

// read() and write(): haptic thread. told(): one other thread.
class WatchedHand final : public HapticDevice {
public:
    // Outlives this, and is there now.
    explicit WatchedHand(LiveHand& hand)
        : hand_(hand)
        , name_(hand.description()) {}

    HandSample read(double t) noexcept override {
        const HandSample sample = hand_.read(t);
        there_.store(hand_.alive(), std::memory_order_relaxed);
        return sample;
    }
    void write(const Wrench& deviceWrench, double dt) noexcept override { hand_.write(deviceWrench, dt); }

    // Once a change: one line for the log; else empty. What comes and goes between two calls is counted only
    // (LiveHandFigures::losses).
    std::string told() {
        const bool there = there_.load(std::memory_order_relaxed);
        if (there == told_) {
            return "";
        }
        told_ = there;
        return name_ + (there ? ": back; the tool resumes from its position"
                              : ": gone or silent: forces fade out, the tool stays; reconnecting");
    }

private:
    LiveHand& hand_;
    std::string name_; // as it was: the haptic thread may write the device's own
    std::atomic<bool> there_{true};
    bool told_ = true;
};

} // namespace fathom
