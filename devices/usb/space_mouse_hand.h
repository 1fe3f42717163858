// SPDX-License-Identifier: Apache-2.0
// A SpaceMouse as the hand: its cap's deflection is a speed, the pose is its integral. It renders no force.
#pragma once

#include "devices/live_hand.h"
#include "devices/usb/space_mouse.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <thread>

namespace fathom {

// How fast full deflection moves the hand.
struct SpaceMouseOptions {
    double speed = 0.05;    // [m/s] at full deflection
    double turnSpeed = 0.5; // [rad/s] at full deflection
    uint32_t clutchBit = 4; // of hand.map; 0 = none
};

// read() makes a few non-blocking system calls. The device reports every 8 to 16 ms while it is held and
// falls silent after a report of zeros; one that is silent while deflected (lost out of radio range) counts
// as let go after kSilence. Its first button is guidance, its second opens the dead-man switch while it is
// down. Unplugged it is looked for ten times a second by vendor and product, on a thread of its own, and goes
// on from the pose where it was, at whatever node it comes back.
class SpaceMouseHand final : public LiveHand {
public:
    // node: /dev/hidrawN; empty = the first SpaceMouse. Throws BadInput: none, no permission (udev rule), not
    // one.
    explicit SpaceMouseHand(const std::filesystem::path& node, const SpaceMouseOptions& options = {});
    // On a descriptor that is read like a hidraw node, non-blocking; owns it. reopen, called on another
    // thread while the device is away, gives the next one or -1; empty = it never comes back.
    SpaceMouseHand(int descriptor, std::string name, const SpaceMouseOptions& options,
                   std::function<int()> reopen = {});
    SpaceMouseHand(const SpaceMouseHand&) = delete;
    SpaceMouseHand& operator=(const SpaceMouseHand&) = delete;
    ~SpaceMouseHand() override;

    HandSample read(double t) noexcept override;
    void write(const Wrench&, double) noexcept override {} // it has no motors

    std::string description() const override { return name_ + " (preset none: forces are shown, not felt)"; }
    std::string preset() const override { return "none"; }
    bool alive() const noexcept override { return descriptor_ >= 0; }
    LiveHandFigures figures() const noexcept override { return figures_; }

    static constexpr double kSilence = 0.1;   // [s]
    static constexpr double kMostStep = 0.05; // [s] that one turn integrates at most

private:
    void takeReports(double t) noexcept;
    void lose() noexcept;
    void seek() noexcept; // the thread

    int descriptor_;
    std::string name_;
    SpaceMouseOptions options_;
    SpaceMouseState state_;
    Pose pose_;
    double before_ = 0.0, heard_ = 0.0; // [s] last turn, last report
    bool started_ = false;
    LiveHandFigures figures_;

    // To the thread and back: descriptors, -1 = none.
    std::function<int()> reopen_;
    std::atomic<int> gone_{-1}, found_{-1};
    std::atomic<bool> seeking_{false}, stop_{false};
    std::thread seeker_;
};

} // namespace fathom
