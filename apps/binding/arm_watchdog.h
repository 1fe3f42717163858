// SPDX-License-Identifier: Apache-2.0
// The engine's side of an arm's watchdog process (devices/serial/line_watchdog.h). A separate process stops
// the arm however the engine ends.
#pragma once

#include "devices/serial/serial_port.h"
#include "engine/scene/scene.h"

#include <string>
#include <sys/types.h>

namespace fathom {

// The first argument that starts it, and the descriptors that it inherits.
inline constexpr const char* kArmWatchdogCommand = "arm-guardian";
inline constexpr int kWatchdogEngine = 3, kWatchdogLine = 4;

std::string protocolName(SceneArm::Driver::Protocol protocol);

// One thread. Only the destructor waits.
class ArmWatchdog {
public:
    // Starts this program again as the watchdog of the open port. Throws Error.
    ArmWatchdog(const SerialPort& port, SceneArm::Driver::Protocol protocol);
    ArmWatchdog(const ArmWatchdog&) = delete;
    ArmWatchdog& operator=(const ArmWatchdog&) = delete;
    // Ends the process and waits for it, so that the port is free.
    ~ArmWatchdog();

    // True when it runs and would stop the arm. False until it is ready, after it was killed, and while it
    // has not answered alive() for kAnswerTimeout.
    bool stands(double now) noexcept;
    bool ended() const noexcept { return ended_; }
    // now [s]: any monotonic clock. Before each exchange with the arm.
    void alive(double now) noexcept;

    static constexpr double kAnswerTimeout = 0.5; // [s]

private:
    void receive() noexcept;

    int socket_ = -1;
    pid_t process_ = -1;
    bool ready_ = false, ended_ = false;
    double next_ = -1e9;        // [s]
    double requestedAt_ = -1.0; // [s] of the first alive() that is not answered; < 0 = none
};

} // namespace fathom
