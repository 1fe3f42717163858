// SPDX-License-Identifier: Apache-2.0
// An arm on a serial line, and the watchdog process that stops it if this process cannot.
#pragma once

#include "apps/binding/arm_line.h"
#include "apps/binding/arm_watchdog.h"
#include "devices/serial/serial_port.h"
#include "engine/scene/scene.h"

#include <memory>
#include <string>

namespace fathom {

// Opening it starts the watchdog and moves nothing. Without a watchdog the arm does not move.
class SerialArm final : public ArmLine {
public:
    // Throws BadInput (no such port), Error (no watchdog).
    SerialArm(const SceneArm::Driver& driver, const std::string& port);

    static std::string description(const SceneArm::Driver& driver, const std::string& port);

    ArmDevice& device() noexcept override { return *device_; }
    bool gone() const noexcept override { return port_.gone(); }
    void awaitWatchdog(const std::atomic<bool>& stop) override;
    bool watched(double now) noexcept override;
    std::string silence() const override;

private:
    std::string description_;
    SceneArm::Driver::Protocol protocol_;
    SerialPort port_;
    std::unique_ptr<ArmDevice> device_;
    std::unique_ptr<ArmWatchdog> watchdog_; // null: killed and not restarted yet
    double nextWatchdog_ = 0.0;             // [s]
};

} // namespace fathom
