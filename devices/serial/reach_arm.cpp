// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/reach_arm.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr double kNever = -1e9;
constexpr double kJawLead = 0.005;         // [m] of setpoints of the jaws before the measurement
constexpr double kReachOverloadTime = 0.1; // [s]
constexpr double kEchoTime = 0.05;         // [s] window in which a packet equal to a sent one is its echo
constexpr uint8_t kPosition = 0x03, kCurrent = 0x05, kRequest = 0x60;
// Base, shoulder, elbow, wrist, jaws.
constexpr std::array<uint8_t, 5> kAlpha{5, 4, 3, 2, 1};
// Axes g to a: base, shoulder, elbow, turn of the elbow, forearm, wrist, jaws.
constexpr std::array<uint8_t, 7> kBravo{7, 6, 5, 4, 3, 2, 1};

} // namespace

std::span<const uint8_t> reachDevices(ReachKind kind) noexcept {
    return kind == ReachKind::Alpha5 ? std::span<const uint8_t>(kAlpha) : std::span<const uint8_t>(kBravo);
}

ReachArm::ReachArm(SerialPort& port, const ReachOptions& options, ReachKind kind)
    : port_(port)
    , options_(options)
    , devices_(reachDevices(kind)) {
    if (options_.period <= 0.0) {
        options_.period = kind == ReachKind::Alpha5 ? 0.02 : 0.03;
    }
    receivedAt_.fill(kNever);
    currentAt_.fill(kNever);
    overSince_.fill(std::numeric_limits<double>::infinity());
    feedback_.homed = true;
    feedback_.age = std::numeric_limits<double>::infinity();
}

double ReachArm::perUnit(size_t axis) const noexcept { // the jaws use millimetres
    return axis == jaws() ? 1e3 : 1.0;
}

// The echo of a half-duplex line looks like an answer, so each sent packet cancels one equal received packet.
// This applies only to lines that echo, because an arm at rest on its setpoint answers with an equal packet.
// Echo is detected by received requests, which no arm sends; requests precede the first setpoint, which needs
// an answer from every axis.
bool ReachArm::isEcho(const ReachPacket& packet, double now) noexcept {
    echoes_ = echoes_ || packet.id == kRequest;
    if (!echoes_) {
        return false;
    }
    for (Sent& sent : sent_) {
        const ReachPacket& p = sent.packet;
        if (now - sent.at <= kEchoTime && p.id == packet.id && p.device == packet.device &&
            p.size == packet.size &&
            std::equal(p.data.begin(), p.data.begin() + p.size, packet.data.begin())) {
            sent.at = kNever;
            return true;
        }
    }
    return false;
}

void ReachArm::takePacket(const ReachPacket& packet, double now) noexcept {
    const bool echo = isEcho(packet, now);
    const auto value = packet.asFloat();
    const auto device = std::find(devices_.begin(), devices_.end(), packet.device);
    if (echo || !value || !std::isfinite(*value) || device == devices_.end()) {
        return;
    }
    const auto axis = static_cast<size_t>(device - devices_.begin());
    if (packet.id == kPosition) {
        feedback_.position[axis] = static_cast<double>(*value) / perUnit(axis);
        receivedAt_[axis] = now;
    } else if (packet.id == kCurrent) {
        feedback_.current[axis] = static_cast<double>(*value) * 1e-3;
        currentAt_[axis] = now;
    }
}

void ReachArm::receive(double now) noexcept {
    readPackets(port_, reader_, [&](const ReachPacket& packet) { takePacket(packet, now); });
    feedback_.damaged = reader_.damaged();
}

void ReachArm::watch(double now, const ArmCommand& command) noexcept {
    const auto axes = static_cast<std::ptrdiff_t>(devices_.size());
    const double oldest = *std::min_element(receivedAt_.begin(), receivedAt_.begin() + axes);
    feedback_.age = oldest == kNever ? std::numeric_limits<double>::infinity() : now - oldest;
    const auto unlimited = std::min_element(currentAt_.begin(), currentAt_.begin() + axes);
    const bool fresh = feedback_.age <= options_.staleAfter;
    feedback_.lacksCurrent = fresh && now - *unlimited > options_.currentStaleAfter
                                 ? static_cast<int>(unlimited - currentAt_.begin())
                                 : -1;
    feedback_.stale = !fresh || feedback_.lacksCurrent >= 0;
    for (size_t k = 0; k < devices_.size(); ++k) {
        const bool over = std::abs(feedback_.current[k]) > options_.mostCurrent;
        overSince_[k] = over ? std::min(overSince_[k], now) : std::numeric_limits<double>::infinity();
        feedback_.overloaded = feedback_.overloaded || now - overSince_[k] > kReachOverloadTime;
    }
    feedback_.holding = command.hold || feedback_.stale || feedback_.overloaded;
}

void ReachArm::send(const ReachPacket& packet, double now) noexcept {
    ReachFrame frame;
    const size_t size = encodeReach(packet, frame);
    port_.write({frame.data(), size});
    sent_[nextSent_] = {packet, now};
    nextSent_ = (nextSent_ + 1) % sent_.size();
}

void ReachArm::sendAll(double now, const ArmCommand& command) noexcept {
    for (size_t k = 0; k < devices_.size(); ++k) {
        const double most = k == jaws() ? kJawLead : options_.lead;
        const double ahead = std::clamp(command.position[k] - feedback_.position[k], -most, most);
        if (feedback_.holding || !std::isfinite(ahead)) {
            send(ReachPacket::ofFloat(kVelocity, devices_[k], 0.0f), now);
        } else {
            const double setpoint = (feedback_.position[k] + ahead) * perUnit(k);
            send(ReachPacket::ofFloat(kPosition, devices_[k], static_cast<float>(setpoint)), now);
        }
        ReachPacket request{kRequest, devices_[k], 2, {}};
        request.data[0] = kPosition;
        request.data[1] = kCurrent;
        send(request, now);
    }
}

void ReachArm::step(double now, const ArmCommand& command) noexcept {
    receive(now);
    watch(now, command);
    if (now >= nextCommand_) {
        nextCommand_ = now + options_.period;
        sendAll(now, command);
    }
}

} // namespace fathom
