// SPDX-License-Identifier: Apache-2.0
// Hands for the operator's window: mouse and keyboard in place of a device, a path that repeats, and the gate
// before any of them that turns forces off whatever the device says.
#pragma once

#include "devices/live_hand.h"
#include "devices/simulated/hand_path.h"
#include "engine/types/triple_buffer.h"

#include <atomic>

namespace fathom::operate {

// The tool goes where the window asks, smoothly: at most kSpeed and kTurnSpeed, without overshoot. ask() from
// one thread, read() and write() from the haptic one; neither ever waits.
class PilotHand final : public HapticDevice {
public:
    explicit PilotHand(const Pose& start); // raw, device frame

    void ask(const HandSample& setpoint) noexcept;
    HandSample read(double t) noexcept override;
    void write(const Wrench&, double) noexcept override {}

    static constexpr double kSpeed = 0.35;    // [m/s]
    static constexpr double kTurnSpeed = 2.0; // [rad/s]

private:
    TripleBuffer<HandSample> setpoints_;
    Pose now_;
    dvec3 velocity_{0.0};
    double before_ = 0.0;
};

// Follows a path again and again when it ends where it began, else once.
class PathHand final : public HapticDevice {
public:
    explicit PathHand(HandPath path);

    HandSample read(double t) noexcept override;
    void write(const Wrench&, double) noexcept override {}

private:
    HandPath path_;
    bool closed_;
};

// Opens the dead-man of any device while forces are off, and presses buttons beside those of the device.
// Forces are off at first. What is not read() and write() comes from any thread.
class GatedHand final : public HapticDevice {
public:
    // live: the same one where it may go away; null = it is always there.
    GatedHand(HapticDevice& hand, const LiveHand* live)
        : hand_(hand)
        , live_(live) {}

    void setForces(bool on) noexcept { off_.store(!on, std::memory_order_release); }
    void press(uint32_t buttons) noexcept { extra_.store(buttons, std::memory_order_relaxed); }
    bool there() const noexcept { return there_.load(std::memory_order_relaxed); } // at the last turn
    HandSample read(double t) noexcept override;
    void write(const Wrench& wrench, double dt) noexcept override { hand_.write(wrench, dt); }

private:
    HapticDevice& hand_;
    const LiveHand* live_;
    std::atomic<uint32_t> extra_{0};
    std::atomic<bool> off_{true}, there_{true};
};

} // namespace fathom::operate
