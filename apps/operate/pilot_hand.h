// SPDX-License-Identifier: Apache-2.0
// Hands for the operator's window: mouse and keyboard as a device, and a gate that turns forces off for any
// device.
#pragma once

#include "apps/operate/button_map.h"
#include "devices/live_hand.h"
#include "engine/types/pose.h"
#include "engine/types/triple_buffer.h"

#include <atomic>

namespace fathom::operate {

// Moves the tool smoothly to the window's setpoint, at most at kSpeed and kTurnSpeed and without overshoot.
// One thread calls ask(), the haptic thread read() and write(); neither waits.
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

// A gate in front of any device: reports its dead-man switch as open while forces are off, and translates and
// adds buttons. Forces are off at first, after a signal, and when the window's thread has not called
// setForces() for kSilence, because then the pilot cannot switch them off. read() and write(): haptic thread;
// the rest: any thread.
class GatedHand final : public HapticDevice {
public:
    // live: the same hand when it may disconnect; null = it is always connected.
    // native: buttons that the engine expects; also the chosen ones at first. ends: set by a signal.
    GatedHand(HapticDevice& hand, const LiveHand* live, const ButtonBits& native,
              const std::atomic<bool>& ends);

    void setForces(bool on) noexcept {
        off_.store(!on, std::memory_order_release);
        calls_.fetch_add(1, std::memory_order_release);
    }
    // Whether forces went off for lack of calls since the last takeSilence().
    bool takeSilence() noexcept { return silent_.exchange(false, std::memory_order_relaxed); }
    void press(uint32_t buttons) noexcept { extra_.store(buttons, std::memory_order_relaxed); }
    void choose(const ButtonBits& buttons) noexcept;
    // While on, buttons have no effect, so that one can be pressed for a mapping.
    void capture(bool on) noexcept { captures_.store(on, std::memory_order_relaxed); }
    // As the device has them.
    uint32_t buttonsDown() const noexcept { return down_.load(std::memory_order_relaxed); }
    uint32_t takePressed() noexcept { return pressed_.exchange(0, std::memory_order_relaxed); }
    bool present() const noexcept { return present_.load(std::memory_order_relaxed); } // at the last tick
    HandSample read(double t) noexcept override;
    void write(const Wrench& wrench, double dt) noexcept override { hand_.write(wrench, dt); }

    static constexpr double kSilence = 2.0; // [s]

private:
    uint32_t buttonsOf(uint32_t raw) noexcept;
    bool isOff(double t) noexcept;

    HapticDevice& hand_;
    const LiveHand* live_;
    std::atomic<uint32_t> extra_{0};
    const ButtonBits native_;
    std::array<std::atomic<uint32_t>, kButtonUses> chosen_;
    std::atomic<uint32_t> down_{0}, pressed_{0}; // down now; pressed since the last takePressed()
    std::atomic<bool> captures_{false};
    const std::atomic<bool>& ends_;
    std::atomic<bool> off_{true}, present_{true}, silent_{false};
    std::atomic<uint32_t> calls_{0}; // of setForces()
    uint32_t callsSeen_ = 0;
    double calledAt_ = 0.0; // [s] first tick that saw the newest call
};

} // namespace fathom::operate
