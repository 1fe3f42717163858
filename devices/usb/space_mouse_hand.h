// SPDX-License-Identifier: Apache-2.0
// A SpaceMouse as the hand: the cap's deflection is a velocity, the pose is its integral. It renders no
// force.
#pragma once

#include "devices/live_hand.h"
#include "devices/reconnector.h"
#include "devices/usb/space_mouse.h"
#include "engine/types/haptic_device.h"

#include <filesystem>
#include <functional>
#include <string>

namespace fathom {

struct DeviceFile;

// Velocity of the hand at full deflection.
struct SpaceMouseOptions {
    double speed = 0.05;                 // [m/s] at full deflection
    double turnSpeed = 0.5;              // [rad/s] at full deflection
    uint32_t clutchBit = kDefaultClutch; // of hand.map; 0 = none
};

// read() makes a few non-blocking system calls. The device reports every 8 to 16 ms while it is held and
// stops reporting after a report of zeros; one that is silent while deflected (out of radio range) counts as
// released after kSilence. Its first button is guidance, its second opens the dead-man switch while it is
// down. After unplugging, a Reconnector searches it ten times per second by vendor and product; it
// resumes from its last pose, at any node.
class SpaceMouseHand final : public LiveHand {
public:
    // node: /dev/hidrawN; empty = the first SpaceMouse. Throws BadInput when there is none, permission is
    // missing (udev rule), or the node is not a SpaceMouse.
    explicit SpaceMouseHand(const std::filesystem::path& node, const SpaceMouseOptions& options = {});
    // Takes a non-blocking descriptor that reads like a hidraw node. reopen, called on another thread while
    // the device is absent, returns the next one or -1; empty = no reconnect.
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

    static constexpr double kSilence = 0.1;  // [s]
    static constexpr double kMaxStep = 0.05; // [s] integrated per tick at most

private:
    SpaceMouseHand(const DeviceFile& file, const SpaceMouseOptions& options);
    void takeReports(double t) noexcept;
    void lose() noexcept;

    int descriptor_;
    std::string name_;
    SpaceMouseOptions options_;
    SpaceMouseState state_;
    Pose pose_;
    double before_ = 0.0, heard_ = 0.0; // [s] last tick, last report
    bool started_ = false;
    LiveHandFigures figures_;
    Reconnector reconnector_;
};

} // namespace fathom
