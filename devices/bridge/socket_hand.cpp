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

template <size_t N>
std::string textOf(const char (&from)[N]) {
    return {from, ::strnlen(from, N)};
}

// -1 = no bridge listens.
int reopenSocket(const std::filesystem::path& path) noexcept {
    DeviceSocket next;
    return DeviceSocket::tryConnect(path, next) == 0 ? next.release() : -1;
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
    , reconnector_([path = path_] { return reopenSocket(path); }, [this] { reportChange(); }) {
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
    status_ = same && soundPose(packet, pose) ? packet.status : 0;
    if (!same && !changed_.load(std::memory_order_relaxed)) {
        std::copy_n(packet.preset, sizeof otherPreset_, otherPreset_);
        changed_.store(true, std::memory_order_release);
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
    fathom_door_hand packet;
    for (int i = 0; i < kMaxPackets; ++i) {
        switch (bridge_.receive(packet, FATHOM_DOOR_HAND)) {
        case SocketEvent::Packet:
            take(packet);
            break;
        case SocketEvent::Empty:
            return;
        case SocketEvent::Bad:
        case SocketEvent::Closed:
            lose();
            return;
        }
    }
}

void SocketHand::lose() noexcept {
    status_ = 0;
    reconnector_.lose(bridge_.release());
}

HandSample SocketHand::read(double) noexcept {
    if (!bridge_.open()) {
        bridge_ = DeviceSocket(reconnector_.take());
    }
    if (bridge_.open()) {
        drain();
    }
    const uint64_t age = socketClock() - lastTime_;
    const bool was = alive_;
    alive_ = bridge_.open() && (status_ & kReady) == kReady && age <= FATHOM_DOOR_SILENCE_NS;
    figures_.losses += was && !alive_ ? 1 : 0;
    if (!alive_) {
        return {last_.deviceThandle, last_.buttons | away_, false};
    }
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

void SocketHand::reportChange() noexcept {
    if (!reported_ && changed_.load(std::memory_order_acquire)) {
        reported_ = true;
        log::warn("{}: the device is now a {}, not a {}: no force until a restart", path_.string(),
                  printable(textOf(otherPreset_)), preset_);
    }
}

std::string SocketHand::description() const {
    return name_ + " at " + path_.string() + " (preset " + preset_ + ")";
}

} // namespace fathom
