// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/serial_arm.h"

#include "apps/binding/arm_axes.h"
#include "devices/serial/eca_arm.h"
#include "devices/serial/reach_arm.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace fathom {

namespace {

using Driver = SceneArm::Driver;
using SerialClock = std::chrono::steady_clock;

constexpr auto kWatchdogStart = std::chrono::seconds(5);
constexpr auto kWatchdogPoll = std::chrono::milliseconds(2);
constexpr double kWatchdogRetry = 0.5; // [s]

std::unique_ptr<ArmDevice> deviceFor(const Driver& driver, SerialPort& port) {
    if (driver.protocol != Driver::Protocol::Eca5e) {
        ReachOptions options;
        options.mostCurrent = driver.current.value_or(options.mostCurrent);
        const bool alpha = driver.protocol == Driver::Protocol::ReachAlpha5;
        return std::make_unique<ReachArm>(port, options, alpha ? ReachKind::Alpha5 : ReachKind::Bravo7);
    }
    EcaOptions options;
    if (driver.current) {
        options.mostCurrent = static_cast<uint8_t>(*driver.current);
        options.stopCurrent = std::min(options.stopCurrent, options.mostCurrent);
    }
    return std::make_unique<EcaArm>(port, options);
}

} // namespace

SerialArm::SerialArm(const Driver& driver, const std::string& port)
    : description_(description(driver, port))
    , protocol_(driver.protocol)
    , port_(port, driver.baud, driver.rs485)
    , device_(deviceFor(driver, port_))
    , watchdog_(std::make_unique<ArmWatchdog>(port_, driver.protocol)) {}

std::string SerialArm::description(const Driver& driver, const std::string& port) {
    const char* const arm = driver.protocol == Driver::Protocol::ReachAlpha5   ? "Reach Alpha 5"
                            : driver.protocol == Driver::Protocol::ReachBravo7 ? "Reach Bravo 7"
                                                                               : "ECA 5E Micro";
    return std::string(arm) + " on " + port;
}

void SerialArm::awaitWatchdog(const std::atomic<bool>& stop) {
    const auto until = SerialClock::now() + kWatchdogStart;
    while (!watchdog_->stands(0.0)) { // no command was sent
        if (stop.load() || watchdog_->ended() || SerialClock::now() > until) {
            throw Error(description_ + ": its watchdog process does not start");
        }
        std::this_thread::sleep_for(kWatchdogPoll);
    }
}

std::string SerialArm::silence() const {
    const int axis = device_->feedback().lacksCurrent;
    return axis < 0 ? ArmLine::silence()
                    : "axis " + std::string(armAxisName(protocol_, static_cast<size_t>(axis))) +
                          " reports no motor current";
}

// Restarts a killed watchdog without waiting for it.
bool SerialArm::watched(double now) noexcept {
    if (watchdog_ && !watchdog_->ended()) {
        watchdog_->alive(now);
        return watchdog_->stands(now);
    }
    if (now < nextWatchdog_) {
        return false;
    }
    nextWatchdog_ = now + kWatchdogRetry;
    try {
        log::warn("{}: its watchdog process ended; the arm is held until a new one runs", description_);
        watchdog_ = std::make_unique<ArmWatchdog>(port_, protocol_);
    } catch (const std::exception&) { // cannot start a process now
        watchdog_.reset();
    }
    return false;
}

} // namespace fathom
