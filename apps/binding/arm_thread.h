// SPDX-License-Identifier: Apache-2.0
// The thread that talks to a real arm, from its first answer to the final stop command.
#pragma once

#include "apps/binding/arm_follower.h"
#include "apps/binding/arm_line.h"

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace fathom {

// Help text of --arm.
inline constexpr const char* kArmHelp = "the real arm: serial port of the scene's arm.driver (the arm "
                                        "moves), or ros2:joints=TOPIC (man fathom)";

class ArmThread;

// Before the arm's files are read, which takes seconds. port: of --arm. Throws BadInput when the scene has no
// arm, or no driver for a serial port.
void checkRealArm(const Scene& scene, const std::string& port);

// setup: the arm of the scene, which passed checkRealArm(). Throws BadInput and whatever ArmThread throws.
std::unique_ptr<ArmThread> openRealArm(const Scene& scene, const ArmSetup& setup, const std::string& port);

// One thread constructs, homes and starts it; afterwards the haptic thread uses only link().
class ArmThread {
public:
    // How to reach the arm, also again after it was unplugged.
    struct Target {
        std::string name;        // of the line, as --arm has it
        std::string description; // protocol and line
        std::function<std::unique_ptr<ArmLine>()> open;
    };
    // Opens the line; moves nothing. joints: of the chain, as `axes`. Throws whatever `open` throws.
    ArmThread(Target target, std::vector<ArmJoint> joints, ArmAxes axes);
    ArmThread(const ArmThread&) = delete;
    ArmThread& operator=(const ArmThread&) = delete;
    // Sends the stop command several times and closes the line.
    ~ArmThread();

    // Waits for an answer, homes the arm (moves it if its encoders are relative) and starts the thread.
    // Returns the posture, inside the joint limits. Throws DeviceLost (no answer, motor overload, no end
    // stop), BadInput (a joint beyond its limits), Error (`stop`, nothing would stop the arm).
    ArmPosture ready(const std::atomic<bool>& stop);

    ArmLink& link() { return link_; }
    const std::string& description() const { return target_.description; }
    // Any thread: the line is gone and has not come back.
    bool gone() const { return gone_.load(std::memory_order_relaxed); }

private:
    void open();
    void run() noexcept;
    void reopen(double now) noexcept;
    ArmStatus exchange(double now) noexcept;
    void note(const ArmStatus& status, double now);
    void standStill() noexcept;
    ArmPosture inLimits(ArmPosture posture) const;

    Target target_;
    std::vector<ArmJoint> joints_;
    ArmAxes axes_;
    std::unique_ptr<ArmLine> line_; // null while it is gone
    std::unique_ptr<ArmFollower> follower_;
    ArmLink link_;
    std::atomic<bool> stop_{false}, gone_{false};
    std::thread thread_;
    double nextTry_ = 0.0, measuredAt_ = 0.0, quietUntil_ = 0.0; // [s]
    uint64_t reopened_ = 0;
    ArmState noted_ = ArmState::Held;
};

} // namespace fathom
