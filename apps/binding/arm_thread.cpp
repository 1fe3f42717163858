// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_thread.h"

#include "apps/binding/ros2_arm.h"
#include "apps/binding/serial_arm.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr auto kPause = std::chrono::milliseconds(2);
constexpr double kHomingTime = 300.0; // [s]
constexpr double kRetry = 0.5;        // [s] between attempts to reopen the line
constexpr double kFinalStop = 0.2;    // [s] stop commands at the end
constexpr double kQuiet = 2.0;        // [s] minimum time between two log lines
constexpr double kOutside = 0.02;     // [rad], [m] tolerance of the joint limits for calibration errors

} // namespace

void checkRealArm(const Scene& scene, const std::string& port) {
    if (!scene.arm) {
        throw BadInput(scene.file.string(), "arm", "missing", "an arm, because of --arm " + port);
    }
    if (!isRos2Arm(port) && !scene.arm->driver) {
        throw BadInput(scene.file.string(), "arm.driver", "missing",
                       "a driver, because --arm names a serial port");
    }
}

std::unique_ptr<ArmThread> openRealArm(const Scene& scene, const ArmSetup& setup, const std::string& port) {
    if (isRos2Arm(port)) {
        const Ros2ArmRequest request = parseRos2ArmRequest(port);
        const ArmModel& model = setup.model;
        return std::make_unique<ArmThread>(
            ArmThread::Target{port, "ROS 2 " + request.joints,
                              [request, model] { return openRos2Arm(request, model); }},
            model.joints, chainAxes(model));
    }
    const ArmAxes axes = armAxes(scene, setup);
    const SceneArm::Driver driver = *scene.arm->driver;
    return std::make_unique<ArmThread>(
        ArmThread::Target{port, SerialArm::description(driver, port),
                          [driver, port] { return std::make_unique<SerialArm>(driver, port); }},
        setup.model.joints, axes);
}

ArmThread::ArmThread(Target target, std::vector<ArmJoint> joints, ArmAxes axes)
    : target_(std::move(target))
    , joints_(std::move(joints))
    , axes_(std::move(axes)) {
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
    line_ = target_.open();
    follower_ = std::make_unique<ArmFollower>(line_->device(), axes_);
}

ArmPosture ArmThread::inLimits(ArmPosture posture) const {
    for (size_t k = 0; k < joints_.size(); ++k) {
        const double q = posture.q[k];
        posture.q[k] = std::clamp(q, joints_[k].lower, joints_[k].upper);
        if (!(std::abs(q - posture.q[k]) <= kOutside)) {
            throw BadInput("--arm " + target_.name, "joint " + joints_[k].name, std::to_string(q),
                           std::to_string(joints_[k].lower) + " to " + std::to_string(joints_[k].upper) +
                               "; signs and zeros are in arm.driver.axes");
        }
    }
    return posture;
}

ArmPosture ArmThread::ready(const std::atomic<bool>& stop) {
    line_->awaitWatchdog(stop);
    const double began = monotonicSeconds();
    double lastReport = began;
    bool logged = false;
    for (double now = began;; now = monotonicSeconds()) {
        if (!line_->watched(now)) {
            throw Error(description() + ": its watchdog process ended");
        }
        const bool ready = follower_->home(now);
        const ArmFeedback& feedback = line_->device().feedback();
        lastReport = feedback.stale ? lastReport : now;
        if (ready) {
            const ArmPosture posture = inLimits(axes_.postureOf(feedback));
            thread_ = std::thread([this] { run(); });
            return posture;
        }
        if (!logged && !feedback.stale) {
            log::warn("{}: homing: each joint moves to its stop without collision checks", description());
            logged = true;
        }
        if (stop.load()) {
            throw Error(description() + ": stopped before it was ready");
        }
        if (line_->gone() || now - lastReport > line_->patience()) {
            throw DeviceLost(description() +
                             (line_->gone() ? ": the serial port is gone" : ": " + line_->silence()));
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
    line_.reset(); // closes the dead line
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

ArmStatus ArmThread::exchange(double now) noexcept {
    ArmStatus status;
    if (!line_ || line_->gone()) {
        reopen(now);
    }
    if (line_) {
        link_.setpoint.refresh();
        ArmSetpoint setpoint = link_.setpoint.front();
        const bool safe = line_->watched(now);
        setpoint.hold = setpoint.hold || !safe; // no motion without a watchdog
        status = follower_->exchange(now, setpoint, now - secondsOf(setpoint.at));
    }
    const bool gone = !line_ || line_->gone();
    status.state = gone ? ArmState::Gone : status.state;
    status.known = status.known && !gone;
    status.reopened = reopened_;
    gone_.store(gone, std::memory_order_relaxed);
    return status;
}

void ArmThread::note(const ArmStatus& status, double now) {
    if (status.state == noted_ || (now < quietUntil_ && status.state != ArmState::Gone)) {
        return;
    }
    if (isFault(status.state)) {
        log::warn("{}: {}: the arm and the tool are held, forces fade out", description(),
                  armStateName(status.state));
        if (status.state == ArmState::Silent && line_) {
            log::warn("{}: {}", description(), line_->silence());
        }
        quietUntil_ = now + kQuiet;
    } else if (isFault(noted_)) {
        log::warn("{}: follows again", description());
    }
    noted_ = status.state;
}

void ArmThread::run() noexcept {
    while (!stop_.load(std::memory_order_relaxed)) {
        const Clock::time_point time = Clock::now();
        const double now = secondsOf(time);
        ArmStatus status = exchange(now);
        status.at = time;
        const double taken = now - status.age;
        if (status.known && taken > measuredAt_) {
            measuredAt_ = taken;
            const std::chrono::duration<double> age(status.age);
            link_.addMeasured(time - std::chrono::duration_cast<Clock::duration>(age), status.posture);
        }
        link_.status.back() = status;
        link_.status.publish();
        try {
            note(status, now);
        } catch (...) { // a failing log must not stop the arm
        }
        std::this_thread::sleep_until(time + kPause);
    }
}

void ArmThread::standStill() noexcept {
    if (!line_) {
        return;
    }
    const double end = monotonicSeconds() + kFinalStop;
    for (double now = end - kFinalStop; now < end && !line_->gone(); now = monotonicSeconds()) {
        line_->watched(now);
        line_->device().step(now, ArmCommand{});
        std::this_thread::sleep_for(kPause);
    }
}

} // namespace fathom
