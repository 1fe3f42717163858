// SPDX-License-Identifier: Apache-2.0
// The engine's end of an arm's guardian (devices/serial/line_guard.h): a process of its own, so that no end
// of the engine leaves an arm moving.
#pragma once

#include "devices/serial/serial_port.h"
#include "engine/scene/scene.h"

#include <string>
#include <sys/types.h>

namespace fathom {

// The program's own first argument for it, and the descriptors that it inherits.
inline constexpr const char* kArmWatchdogCommand = "arm-guardian";
inline constexpr int kWatchdogEngine = 3, kWatchdogLine = 4;

std::string protocolName(SceneArm::Driver::Protocol protocol);

// One thread. Waits for nothing but in the end.
class ArmWatchdog {
public:
    // Starts this program again, as the guardian of the line that is open. Throws Error.
    ArmWatchdog(const SerialPort& port, SceneArm::Driver::Protocol protocol);
    ArmWatchdog(const ArmWatchdog&) = delete;
    ArmWatchdog& operator=(const ArmWatchdog&) = delete;
    // Says farewell and waits until it has ended, so that the line is free.
    ~ArmWatchdog();

    // It is there and would stop the arm. False at first, and when it was killed.
    bool stands() noexcept;
    bool ended() const noexcept { return ended_; }
    // now [s]: any monotonic clock. Before each exchange with the arm.
    void alive(double now) noexcept;

private:
    void hear() noexcept;

    int socket_ = -1;
    pid_t process_ = -1;
    bool ready_ = false, ended_ = false;
    double next_ = -1e9; // [s]
};

} // namespace fathom
