// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/eca_arm.h"

#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr int kPressedFrames = 3; // consecutive readings at the stop: a single one may be noise
constexpr double kAmpere = 0.094e-3;
constexpr double kAtRest = 0.02;      // [rad] by which a joint at rest may move
constexpr double kFullSpeed = 0.5;    // [rad/s] at speed 4095; not verified
constexpr double kFaster = 1.5;       // share of it that a joint may move at
constexpr double kOverloadTime = 0.3; // [s]
constexpr double kMaxCounts = 8000;   // of an encoder between two frames

} // namespace

double EcaArm::radiansPerCount(size_t joint) noexcept {
    constexpr std::array<double, 4> kCountsPerDegree{798.0, 588.14, 569.88, 8.89};
    return joint < kCountsPerDegree.size() ? kDegree / kCountsPerDegree[joint]
                                           : 2.0 * std::asin(62.5 / 78.0) / 7000.0;
}

EcaArm::EcaArm(SerialPort& port, const EcaOptions& options)
    : port_(port)
    , options_(options) {
    overSince_.fill(std::numeric_limits<double>::infinity());
    feedback_.age = std::numeric_limits<double>::infinity();
}

void EcaArm::loseHome() noexcept {
    homing_ = 0;
    feedback_.homed = false;
    pressed_.fill(0);
}

// [counts] between two frames that are `silence` [s] apart, or were delivered together.
int EcaArm::mostMoved(size_t joint, double silence) const noexcept {
    const double moving = kFaster * kFullSpeed * std::max(silence, options_.period);
    const double most = silence > options_.staleAfter ? kAtRest : moving + kAtRest;
    return static_cast<int>(std::min(kMaxCounts, most / radiansPerCount(joint)));
}

void EcaArm::takeStatus(const std::array<EcaStatus, kEcaJoints>& status, double now) noexcept {
    for (size_t j = 0; j < kEcaJoints; ++j) {
        // Shortest difference modulo 2^16: valid while a joint moves less than half the range between frames.
        const auto moved = static_cast<int16_t>(status[j].encoder - encoder_[j]);
        if (any_ && std::abs(int{moved}) > mostMoved(j, now - receivedAt_)) {
            loseHome();
        }
        counts_[j] += any_ ? moved : 0;
        encoder_[j] = status[j].encoder;
        current_[j] = status[j].current;
        pressed_[j] = current_[j] >= options_.stopCurrent ? pressed_[j] + 1 : 0;
        feedback_.position[j] = static_cast<double>(counts_[j] - zero_[j]) * radiansPerCount(j);
        feedback_.current[j] = std::max(0.0, kAmpere * current_[j] - 0.2e-3);
    }
    any_ = true;
    receivedAt_ = now;
}

void EcaArm::receive(double now) noexcept {
    readPackets(port_, reader_, [&](const EcaBytes& frame) {
        if (frame != sent_) { // a half-duplex line echoes sent bytes
            takeStatus(statusOf(frame), now);
        }
    });
    feedback_.damaged = reader_.damaged();
}

void EcaArm::watch(double now, const ArmCommand& command) noexcept {
    feedback_.age = any_ ? now - receivedAt_ : std::numeric_limits<double>::infinity();
    feedback_.stale = !(feedback_.age <= options_.staleAfter);
    for (size_t j = 0; j < kEcaJoints; ++j) {
        const bool over = current_[j] > options_.mostCurrent;
        overSince_[j] = over ? std::min(overSince_[j], now) : std::numeric_limits<double>::infinity();
        feedback_.overloaded = feedback_.overloaded || now - overSince_[j] > kOverloadTime;
    }
    feedback_.holding = command.hold || feedback_.stale || feedback_.overloaded || homing_ < kEcaJoints;
}

EcaDemand EcaArm::speedDemand(double speed) const noexcept {
    EcaDemand demand;
    demand.currentLimit = options_.currentLimit;
    const double counts = std::min(4095.0, std::round(4095.0 * std::abs(speed) / kFullSpeed));
    if (!(counts >= 1.0)) {
        return demand;
    }
    demand.kind = speed < 0.0 ? EcaDemand::Kind::SpeedCw : EcaDemand::Kind::SpeedCcw;
    demand.speed = static_cast<uint16_t>(counts);
    return demand;
}

std::array<EcaDemand, kEcaJoints> EcaArm::demandsFor(const ArmCommand& command) noexcept {
    std::array<EcaDemand, kEcaJoints> demands;
    demands.fill(speedDemand(0.0));
    const bool may = !command.hold && !feedback_.stale && !feedback_.overloaded;
    if (may && homing_ < kEcaJoints) {
        const size_t j = homing_;
        if (pressed_[j] >= kPressedFrames) { // the joint is at its stop
            zero_[j] = counts_[j] - std::llround(options_.stop[j] / radiansPerCount(j));
            feedback_.position[j] = options_.stop[j];
            feedback_.homed = ++homing_ == kEcaJoints;
        } else {
            demands[j] = speedDemand(-options_.homingSpeed);
        }
        return demands;
    }
    for (size_t j = 0; may && j < kEcaJoints; ++j) {
        const double error = command.position[j] - feedback_.position[j];
        demands[j] = std::isfinite(error) ? speedDemand(options_.gain * error) : speedDemand(0.0);
    }
    return demands;
}

void EcaArm::step(double now, const ArmCommand& command) noexcept {
    receive(now);
    watch(now, command);
    if (now >= nextCommand_) {
        nextCommand_ = now + options_.period;
        sent_ = encodeEca(demandsFor(command));
        port_.write(sent_);
    }
}

} // namespace fathom
