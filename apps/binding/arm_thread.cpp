// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_thread.h"

#include "devices/serial/eca_arm.h"
#include "devices/serial/reach_arm.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(2);
constexpr double kNoAnswer = 5.0, kHomingTime = 300.0; // [s]
constexpr auto kWatchdogStart = std::chrono::seconds(5);
constexpr double kRetry = 0.5;     // [s] between attempts to reopen the port or restart the watchdog
constexpr double kLastWords = 0.2; // [s] stop commands at the end
constexpr double kQuiet = 2.0;     // [s] minimum time between two log lines
constexpr double kOutside = 0.02;  // [rad], [m] tolerance of the joint limits for calibration errors

double secondsAt(Clock::time_point time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

std::unique_ptr<ArmDevice> deviceFor(const SceneArm::Driver& driver, SerialPort& port) {
    using Protocol = SceneArm::Driver::Protocol;
    if (driver.protocol != Protocol::Eca5e) {
        ReachOptions options;
        options.mostCurrent = driver.current.value_or(options.mostCurrent);
        return std::make_unique<ReachArm>(
            port, options, driver.protocol == Protocol::ReachAlpha5 ? ReachKind::Alpha5 : ReachKind::Bravo7);
    }
    EcaOptions options;
    if (driver.current) {
        options.mostCurrent = static_cast<uint8_t>(*driver.current);
        options.stopCurrent = std::min(options.stopCurrent, options.mostCurrent);
    }
    return std::make_unique<EcaArm>(port, options);
}

} // namespace

std::unique_ptr<ArmThread> openRealArm(const Scene& scene, const ArmRig* rig, const std::string& port) {
    if (rig == nullptr) {
        throw BadInput(scene.file.string(), "arm", "missing",
                       "an arm with a driver, because --arm names a serial port");
    }
    return std::make_unique<ArmThread>(scene, *rig, port);
}

ArmThread::Line::Line(const SceneArm::Driver& driver, const std::string& name)
    : port(name, driver.baud, driver.rs485)
    , device(deviceFor(driver, port))
    , watchdog(std::make_unique<ArmWatchdog>(port, driver.protocol)) {}

ArmThread::ArmThread(const Scene& scene, const ArmRig& rig, std::string port)
    : joints_(rig.model.joints)
    , axes_(armAxes(scene, rig))
    , port_(std::move(port)) {
    driver_ = *scene.arm->driver;
    open();
}

ArmThread::~ArmThread() {
    stop_.store(true);
    if (thread_.joinable()) {
        thread_.join();
    }
    standStill();
}

void ArmThread::open() {
    follower_.reset();
    line_.reset();
    line_ = std::make_unique<Line>(driver_, port_);
    follower_ = std::make_unique<ArmFollower>(*line_->device, axes_);
}

std::string ArmThread::description() const {
    using Protocol = SceneArm::Driver::Protocol;
    const char* const arm = driver_.protocol == Protocol::ReachAlpha5   ? "Reach Alpha 5"
                            : driver_.protocol == Protocol::ReachBravo7 ? "Reach Bravo 7"
                                                                        : "ECA 5E Micro";
    return std::string(arm) + " on " + port_;
}

ArmPosture ArmThread::inLimits(ArmPosture posture) const {
    for (size_t k = 0; k < joints_.size(); ++k) {
        const double q = posture.q[k];
        posture.q[k] = std::clamp(q, joints_[k].lower, joints_[k].upper);
        if (!(std::abs(q - posture.q[k]) <= kOutside)) {
            throw BadInput("--arm " + port_, "joint " + joints_[k].name, std::to_string(q),
                           std::to_string(joints_[k].lower) + " to " + std::to_string(joints_[k].upper) +
                               "; signs and zeros are in arm.driver.axes");
        }
    }
    return posture;
}

void ArmThread::awaitWatchdog(const std::atomic<bool>& stop) {
    const auto until = Clock::now() + kWatchdogStart;
    while (!line_->watchdog->stands()) {
        if (stop.load() || line_->watchdog->ended() || Clock::now() > until) {
            throw Error(description() + ": its watchdog process does not start");
        }
        std::this_thread::sleep_for(kPause);
    }
}

ArmPosture ArmThread::ready(const std::atomic<bool>& stop) {
    awaitWatchdog(stop);
    const double began = secondsAt(Clock::now());
    double heard = began;
    bool told = false;
    for (double now = began;; now = secondsAt(Clock::now())) {
        if (!guarded(now)) {
            throw Error(description() + ": its watchdog process ended");
        }
        const bool ready = follower_->home(now);
        const ArmFeedback& feedback = line_->device->feedback();
        heard = feedback.stale ? heard : now;
        if (ready) {
            const ArmPosture posture = inLimits(axes_.postureOf(feedback));
            thread_ = std::thread([this] { run(); });
            return posture;
        }
        if (!told && !feedback.stale) {
            log::warn("{}: homing: each joint moves to its stop without collision checks", description());
            told = true;
        }
        if (stop.load()) {
            throw Error(description() + ": stopped before it was ready");
        }
        if (line_->port.gone() || now - heard > kNoAnswer) {
            throw DeviceLost(description() +
                             (line_->port.gone() ? ": the serial port is gone" : ": no answer"));
        }
        if (feedback.overloaded || now - began > kHomingTime) {
            throw DeviceLost(description() + (feedback.overloaded ? ": a motor draws too much current"
                                                                  : ": no end stop was found"));
        }
        std::this_thread::sleep_for(kPause);
    }
}

void ArmThread::reopen(double now) noexcept {
    follower_.reset();
    line_.reset(); // closes the dead port
    if (now < nextTry_) {
        return;
    }
    nextTry_ = now + kRetry;
    try {
        open();
        ++reopened_;
    } catch (const std::exception&) { // not available yet
        line_.reset();
    }
}

// Restarts a killed watchdog without waiting for it.
bool ArmThread::guarded(double now) noexcept {
    std::unique_ptr<ArmWatchdog>& watchdog = line_->watchdog;
    if (watchdog && !watchdog->ended()) {
        watchdog->alive(now);
        return watchdog->stands();
    }
    if (now < nextWatchdog_) {
        return false;
    }
    nextWatchdog_ = now + kRetry;
    try {
        log::warn("{}: its watchdog process ended; the arm is held until a new one runs", description());
        watchdog = std::make_unique<ArmWatchdog>(line_->port, driver_.protocol);
    } catch (const std::exception&) { // cannot start a process now
        watchdog.reset();
    }
    return false;
}

ArmStatus ArmThread::exchange(double now) noexcept {
    ArmStatus told;
    if (!line_ || line_->port.gone()) {
        reopen(now);
    }
    if (line_) {
        link_.setpoint.refresh();
        ArmSetpoint setpoint = link_.setpoint.front();
        const bool safe = guarded(now);
        setpoint.hold = setpoint.hold || !safe; // no motion without a watchdog
        told = follower_->exchange(now, setpoint, now - secondsAt(setpoint.at));
    }
    const bool gone = !line_ || line_->port.gone();
    told.state = gone ? ArmState::Gone : told.state;
    told.known = told.known && !gone;
    told.reopened = reopened_;
    gone_.store(gone, std::memory_order_relaxed);
    return told;
}

void ArmThread::note(const ArmStatus& told, double now) {
    if (told.state == noted_ || (now < quietUntil_ && told.state != ArmState::Gone)) {
        return;
    }
    if (isFault(told.state)) {
        log::warn("{}: {}: the arm and the tool are held, forces fade out", description(),
                  armStateName(told.state));
        quietUntil_ = now + kQuiet;
    } else if (isFault(noted_)) {
        log::warn("{}: follows again", description());
    }
    noted_ = told.state;
}

void ArmThread::run() noexcept {
    while (!stop_.load(std::memory_order_relaxed)) {
        const Clock::time_point time = Clock::now();
        const double now = secondsAt(time);
        ArmStatus told = exchange(now);
        told.at = time;
        const double taken = now - told.age;
        if (told.known && taken > measuredAt_) {
            measuredAt_ = taken;
            ArmPosture posture = told.posture;
            posture.grasp =
                std::isfinite(posture.grasp) ? posture.grasp : link_.setpoint.front().posture.grasp;
            const std::chrono::duration<double> age(told.age);
            link_.measured.add(time - std::chrono::duration_cast<Clock::duration>(age), posture);
        }
        link_.status.back() = told;
        link_.status.publish();
        try {
            note(told, now);
        } catch (...) { // a failing log must not stop the arm
        }
        std::this_thread::sleep_until(time + kPause);
    }
}

void ArmThread::standStill() noexcept {
    if (!line_) {
        return;
    }
    const double end = secondsAt(Clock::now()) + kLastWords;
    for (double now = end - kLastWords; now < end && !line_->port.gone(); now = secondsAt(Clock::now())) {
        guarded(now);
        line_->device->step(now, ArmCommand{});
        std::this_thread::sleep_for(kPause);
    }
}

} // namespace fathom
