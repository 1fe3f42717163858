// SPDX-License-Identifier: Apache-2.0
// The thread that speaks to a real arm over its serial line, from its first answer to the last command: stand
// still. A guardian process says it where this one cannot any more; without one nothing moves.
#pragma once

#include "apps/binding/arm_follower.h"
#include "apps/binding/arm_watchdog.h"
#include "devices/serial/serial_port.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>

namespace fathom {

// What --arm takes.
inline constexpr const char* kArmHelp =
    "serial port of the real arm in the scene's arm.driver; the arm moves";

class ArmThread;

// rig: of the scene. Throws BadInput where the scene has no arm or no driver, and as ArmThread.
std::unique_ptr<ArmThread> openRealArm(const Scene& scene, const ArmRig* rig, const std::string& port);

// Made, homed and started by one thread; then the haptic thread speaks to it through link() alone.
class ArmThread {
public:
    // Opens the line and starts its guardian, moves nothing. Throws BadInput (no driver in the scene, no such
    // line), Error (no guardian).
    ArmThread(const Scene& scene, const ArmRig& rig, std::string port);
    ArmThread(const ArmThread&) = delete;
    ArmThread& operator=(const ArmThread&) = delete;
    // Tells the arm to stand still, several times, and closes the line.
    ~ArmThread();

    // Waits for the arm to answer and homes it, which moves it where encoders are relative; starts the
    // thread. Returns where it stands, inside the joint limits. Throws DeviceLost (no answer, a motor that
    // draws too much, no stop found), BadInput (a joint beyond its limits), Error (`stop`, no guardian).
    ArmPosture ready(const std::atomic<bool>& stop);

    ArmLink& link() { return link_; }
    std::string description() const; // protocol and line
    // Any thread: the serial port is gone and has not come back.
    bool gone() const { return gone_.load(std::memory_order_relaxed); }

private:
    struct Line { // port, what speaks on it, who watches that
        Line(const SceneArm::Driver& driver, const std::string& port);
        SerialPort port;
        std::unique_ptr<ArmDevice> device;
        std::unique_ptr<ArmWatchdog> watchdog; // null: it was killed, and another could not be started yet
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
    std::unique_ptr<Line> line_; // null while it is gone
    std::unique_ptr<ArmFollower> follower_;
    ArmLink link_;
    std::atomic<bool> stop_{false}, gone_{false};
    std::thread thread_;
    double nextTry_ = 0.0, nextWatchdog_ = 0.0, measuredAt_ = 0.0, quietUntil_ = 0.0; // [s]
    uint64_t reopened_ = 0;
    ArmState noted_ = ArmState::Held;
};

} // namespace fathom
