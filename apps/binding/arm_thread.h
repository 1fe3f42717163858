// SPDX-License-Identifier: Apache-2.0
// The thread that talks to a real arm over its serial port, from its first answer to the final stop command.
// A watchdog process sends that command if this process cannot; without it the arm does not move.
#pragma once

#include "apps/binding/arm_follower.h"
#include "apps/binding/arm_watchdog.h"
#include "devices/serial/serial_port.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>

namespace fathom {

// Help text of --arm.
inline constexpr const char* kArmHelp =
    "serial port of the real arm that the scene's arm.driver describes; the arm moves";

class ArmThread;

// rig: the arm of the scene. Throws BadInput when the scene has no arm or no driver, and whatever ArmThread
// throws.
std::unique_ptr<ArmThread> openRealArm(const Scene& scene, const ArmRig* rig, const std::string& port);

// One thread constructs, homes and starts it; afterwards the haptic thread uses only link().
class ArmThread {
public:
    // Opens the port and starts the watchdog; moves nothing. Throws BadInput (no driver in the scene, no such
    // port), Error (no watchdog).
    ArmThread(const Scene& scene, const ArmRig& rig, std::string port);
    ArmThread(const ArmThread&) = delete;
    ArmThread& operator=(const ArmThread&) = delete;
    // Sends the stop command several times and closes the port.
    ~ArmThread();

    // Waits for an answer, homes the arm (moves it if its encoders are relative) and starts the thread.
    // Returns the posture, inside the joint limits. Throws DeviceLost (no answer, motor overload, no end
    // stop), BadInput (a joint beyond its limits), Error (`stop`, no watchdog).
    ArmPosture ready(const std::atomic<bool>& stop);

    ArmLink& link() { return link_; }
    std::string description() const; // protocol and port
    // Any thread: the serial port is gone and has not come back.
    bool gone() const { return gone_.load(std::memory_order_relaxed); }

private:
    struct Line { // port, driver and watchdog
        Line(const SceneArm::Driver& driver, const std::string& port);
        SerialPort port;
        std::unique_ptr<ArmDevice> device;
        std::unique_ptr<ArmWatchdog> watchdog; // null: killed and not restarted yet
    };
    void open();
    void run() noexcept;
    void reopen(double now) noexcept;
    void awaitWatchdog(const std::atomic<bool>& stop);
    bool guarded(double now) noexcept;
    ArmStatus exchange(double now) noexcept;
    void note(const ArmStatus& told, double now);
    void standStill() noexcept;
    ArmPosture inLimits(ArmPosture posture) const;

    SceneArm::Driver driver_;
    std::vector<ArmJoint> joints_;
    ArmAxes axes_;
    std::string port_;
    std::unique_ptr<Line> line_; // null while the port is gone
    std::unique_ptr<ArmFollower> follower_;
    ArmLink link_;
    std::atomic<bool> stop_{false}, gone_{false};
    std::thread thread_;
    double nextTry_ = 0.0, nextWatchdog_ = 0.0, measuredAt_ = 0.0, quietUntil_ = 0.0; // [s]
    uint64_t reopened_ = 0;
    ArmState noted_ = ArmState::Held;
};

} // namespace fathom
