// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/socket_hand.h"

#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <poll.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr int kMaxPackets = 64; // per tick
constexpr uint32_t kReady = FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED;
constexpr uint32_t kMaxOld = 50;        // ticks with old samples, as after a pause of the engine
constexpr uint64_t kQuiet = 5000000000; // [ns] between two reports

template <size_t N>
std::string textOf(const char (&from)[N]) {
    return {from, ::strnlen(from, N)};
}

// -1 = no bridge listens.
int reopenSocket(const std::filesystem::path& path) noexcept {
    DeviceSocket next;
    return DeviceSocket::tryConnect(path, next) == 0 ? next.release() : -1;
}

// The first number of a pose that is not finite, or else its orientation.
std::string poseFault(const fathom_door_hand& packet) {
    const double* p = packet.position;
    const double* q = packet.orientation;
    if (!std::all_of(p, p + 3, [](double number) { return std::isfinite(number); })) {
        return fmt::format("position {:.4g} {:.4g} {:.4g} (allowed: finite numbers)", p[0], p[1], p[2]);
    }
    return fmt::format("orientation {:.4g} {:.4g} {:.4g} {:.4g} (allowed: a quaternion w x y z of length 1; "
                       "1 0 0 0 if the device does not sense it)",
                       q[0], q[1], q[2], q[3]);
}

// One line. preset: of the device that was there first.
std::string inWords(const SocketRefusal& refusal, const std::string& preset) {
    const fathom_door_hand& packet = refusal.packet;
    switch (refusal.kind) {
    case SocketRefusal::Kind::Pose:
        return "samples refused: " + poseFault(packet);
    case SocketRefusal::Kind::Stamp:
        return fmt::format("samples refused: time_ns {} is {:.4g} s behind CLOCK_MONOTONIC (allowed: at most "
                           "{:.4g} s)",
                           packet.header.time_ns, 1e-9 * static_cast<double>(refusal.age),
                           1e-9 * FATHOM_DOOR_SILENCE_NS);
    case SocketRefusal::Kind::Packet:
        return "connection ended: " +
               socketFault(packet.header, refusal.bytes, FATHOM_DOOR_HAND, sizeof packet).text();
    case SocketRefusal::Kind::Preset:
        return fmt::format("the device is now a {}, not a {}: no force until a restart",
                           printable(textOf(packet.preset)), printable(preset));
    case SocketRefusal::Kind::None:
        break;
    }
    return {};
}

} // namespace

bool soundPose(const fathom_door_hand& packet, Pose& out) noexcept {
    const dquat q(packet.orientation[0], packet.orientation[1], packet.orientation[2], packet.orientation[3]);
    const double length = glm::dot(q, q);
    if (!(length > 0.5 && length < 2.0)) {
        return false;
    }
    out = {{packet.position[0], packet.position[1], packet.position[2]}, glm::normalize(q)};
    return isFinite(out);
}

SocketHand::SocketHand(std::filesystem::path path, uint32_t clutchBit, double patience)
    : path_(std::move(path))
    , away_(FATHOM_DOOR_DEAD_MAN_OPEN | clutchBit)
    , bridge_(DeviceSocket::connect(path_))
    , reconnector_([path = path_] { return reopenSocket(path); }, [this] { reportRefusal(); }) {
    last_.buttons = away_;
    awaitFirst(patience);
}

SocketHand::~SocketHand() {
    fathom_door_wrench packet{};
    packet.header = socketHeader(FATHOM_DOOR_WRENCH, sizeof packet, ++sent_);
    packet.flags = FATHOM_DOOR_LAST;
    bridge_.send(packet);
}

void SocketHand::awaitFirst(double patience) {
    const uint64_t until = socketClock() + static_cast<uint64_t>(std::max(0.0, patience) * 1e9);
    fathom_door_hand packet{};
    for (;;) {
        size_t got = 0;
        switch (bridge_.receive(packet, FATHOM_DOOR_HAND, &got)) {
        case SocketEvent::Packet:
            preset_ = textOf(packet.preset);
            name_ = printable(textOf(packet.name));
            take(packet);
            return;
        case SocketEvent::Bad: {
            const SocketFault fault = socketFault(packet.header, got, FATHOM_DOOR_HAND, sizeof packet);
            throw BadInput("socket", path_.string(), fault.found, fault.allowed);
        }
        case SocketEvent::Closed:
            throw BadInput("socket", path_.string(), "closed by the bridge",
                           "a bridge without another engine");
        case SocketEvent::Empty:
            break;
        }
        const uint64_t now = socketClock();
        if (now >= until) {
            throw BadInput("socket", path_.string(), "no sample",
                           "a bridge that sends one at least every 5 ms");
        }
        pollfd waiting{bridge_.descriptor(), POLLIN, 0};
        ::poll(&waiting, 1, static_cast<int>((until - now) / 1000000) + 1);
    }
}

void SocketHand::take(const fathom_door_hand& packet) noexcept {
    Pose pose;
    // A device of another kind has other limits, so the springs do not fit it.
    const bool same = std::strncmp(packet.preset, preset_.c_str(), sizeof packet.preset) == 0;
    const bool sound = soundPose(packet, pose), ready = (packet.status & kReady) == kReady;
    status_ = same && sound ? packet.status : 0;
    if (!same) {
        refuse(SocketRefusal::Kind::Preset, packet, sizeof packet);
    } else if (!sound && ready) {
        refuse(SocketRefusal::Kind::Pose, packet, sizeof packet);
    }
    if ((status_ & kReady) == kReady) {
        last_.deviceThandle = pose;
    }
    last_.buttons = packet.buttons;
    lastTime_ = std::min(packet.header.time_ns, socketClock()); // packets in the queue may be old
    lastSequence_ = packet.header.sequence;
    ++figures_.samples;
}

void SocketHand::drain() noexcept {
    fathom_door_hand packet{};
    for (int i = 0; i < kMaxPackets; ++i) {
        size_t got = 0;
        switch (bridge_.receive(packet, FATHOM_DOOR_HAND, &got)) {
        case SocketEvent::Packet:
            take(packet);
            break;
        case SocketEvent::Empty:
            return;
        case SocketEvent::Bad:
            refuse(SocketRefusal::Kind::Packet, packet, got);
            lose();
            return;
        case SocketEvent::Closed:
            lose();
            return;
        }
    }
}

// Samples that have just arrived and are too old have a stamp of another clock, or of a slow line. After a
// pause of the engine they are old for a few ticks only.
void SocketHand::checkAge(uint64_t now) noexcept {
    oldInRow_ = now - lastTime_ > FATHOM_DOOR_SILENCE_NS ? oldInRow_ + 1 : 0;
    if (oldInRow_ >= kMaxOld && (status_ & kReady) == kReady) {
        fathom_door_hand packet{};
        packet.header.time_ns = lastTime_;
        refuse(SocketRefusal::Kind::Stamp, packet, sizeof packet);
    }
}

void SocketHand::refuse(SocketRefusal::Kind kind, const fathom_door_hand& packet, size_t bytes) noexcept {
    if (kind == refused_) {
        return;
    }
    refused_ = kind;
    refusal_.back() = {kind, ++refusals_, packet, bytes, socketClock() - packet.header.time_ns};
    refusal_.publish();
}

void SocketHand::lose() noexcept {
    status_ = 0;
    reconnector_.lose(bridge_.release());
}

HandSample SocketHand::read(double) noexcept {
    if (!bridge_.open()) {
        bridge_ = DeviceSocket(reconnector_.take());
    }
    const uint64_t before = figures_.samples;
    if (bridge_.open()) {
        drain();
    }
    const uint64_t now = socketClock(), age = now - lastTime_;
    if (figures_.samples != before) {
        checkAge(now);
    }
    const bool was = alive_;
    alive_ = bridge_.open() && (status_ & kReady) == kReady && age <= FATHOM_DOOR_SILENCE_NS;
    figures_.losses += was && !alive_ ? 1 : 0;
    if (!alive_) {
        return {last_.deviceThandle, last_.buttons | away_, false};
    }
    refuse(SocketRefusal::Kind::None, {}, 0);
    figures_.worstAge = std::max(figures_.worstAge, static_cast<double>(age) * 1e-9);
    return last_;
}

void SocketHand::write(const Wrench& wrench, double) noexcept {
    if (!bridge_.open()) {
        return;
    }
    fathom_door_wrench packet{};
    packet.header = socketHeader(FATHOM_DOOR_WRENCH, sizeof packet, ++sent_);
    packet.hand_sequence = lastSequence_;
    if (alive_ && isFinite(wrench.force) && isFinite(wrench.torque)) {
        packet.flags = FATHOM_DOOR_FORCES_ON;
        std::copy_n(std::array{wrench.force.x, wrench.force.y, wrench.force.z}.data(), 3, packet.force);
        std::copy_n(std::array{wrench.torque.x, wrench.torque.y, wrench.torque.z}.data(), 3, packet.torque);
    }
    switch (bridge_.send(packet)) {
    case SocketEvent::Packet:
        break;
    case SocketEvent::Empty:
        ++figures_.unsent;
        break;
    default:
        lose();
    }
}

// Once per refusal that lasts. A bridge that changes between right and wrong is named every five seconds.
void SocketHand::reportRefusal() noexcept {
    refusal_.refresh();
    const SocketRefusal& newest = refusal_.front();
    const uint64_t now = socketClock();
    if (newest.kind == SocketRefusal::Kind::None || newest.number == reported_ || now < quietUntil_) {
        return;
    }
    reported_ = newest.number;
    quietUntil_ = now + kQuiet;
    log::warn("{}: {}", path_.string(), inWords(newest, preset_));
}

std::string SocketHand::description() const {
    return name_ + " at " + path_.string() + " (preset " + preset_ + ")";
}

} // namespace fathom
