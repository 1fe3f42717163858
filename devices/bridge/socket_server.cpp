// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/socket_server.h"

#include "engine/types/log.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <unistd.h>

namespace fathom {

namespace {

constexpr int kBacklog = 1;
constexpr int kMaxRequests = 256; // per poll: a flooding engine must not delay the device

template <size_t N>
void copyText(char (&to)[N], const std::string& from) {
    std::memcpy(to, from.data(), std::min(from.size(), N - 1)); // the rest is zero already
}

dvec3 vectorOf(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

} // namespace

SocketServer::SocketServer(const Options& options)
    : path_(options.path)
    , endpoint_(DeviceSocket::listen(options.path, kBacklog))
    , gate_(options.forceLimit, options.torqueLimit) {
    copyText(hand_.preset, options.preset);
    copyText(hand_.name, options.name);
}

SocketServer::~SocketServer() {
    ::unlink(path_.c_str());
}

// In this order: an engine that follows one that has ended is no second engine.
void SocketServer::poll() {
    takeWrenches();
    takeNewcomer();
}

void SocketServer::takeNewcomer() {
    DeviceSocket newcomer = endpoint_.accept();
    if (!newcomer.open()) {
        return;
    }
    if (engine_.open()) {
        log::warn("{}: rejected a second engine", path_.string());
        return; // closes it
    }
    engine_ = std::move(newcomer);
    gate_.close();
    hand_.wrench_sequence = 0;
    log::info("{}: engine connected", path_.string());
}

void SocketServer::takeWrenches() {
    fathom_door_wrench packet;
    for (int i = 0; i < kMaxRequests && engine_.open(); ++i) {
        size_t got = 0;
        switch (engine_.receive(packet, FATHOM_DOOR_WRENCH, &got)) {
        case SocketEvent::Empty:
            return;
        case SocketEvent::Closed:
            drop({});
            return;
        case SocketEvent::Bad:
            drop(socketFault(packet.header, got, FATHOM_DOOR_WRENCH, sizeof packet).text());
            return;
        case SocketEvent::Packet:
            break;
        }
        hand_.wrench_sequence = packet.header.sequence;
        if ((packet.flags & FATHOM_DOOR_LAST) != 0) {
            gate_.close();
        } else {
            // Judge by its stamp: after a delay of this process, queued packets may be old.
            gate_.accept({vectorOf(packet.force), vectorOf(packet.torque)},
                         std::min(packet.header.time_ns, socketClock()));
        }
    }
}

void SocketServer::drop(const std::string& why) {
    gate_.close();
    engine_.close();
    if (why.empty()) {
        log::info("{}: engine gone, zero force", path_.string());
    } else {
        ++dropped_;
        log::warn("{}: engine dropped, zero force: {}", path_.string(), why);
    }
}

void SocketServer::send(const HandSample& sample, uint32_t status) noexcept {
    if (!engine_.open()) {
        return;
    }
    hand_.header = socketHeader(FATHOM_DOOR_HAND, sizeof hand_, ++sent_);
    hand_.status = status;
    hand_.buttons = sample.buttons;
    const dvec3& p = sample.deviceThandle.position;
    const dquat& q = sample.deviceThandle.rotation;
    std::copy_n(std::array{p.x, p.y, p.z}.data(), 3, hand_.position);
    std::copy_n(std::array{q.w, q.x, q.y, q.z}.data(), 4, hand_.orientation);
    // A full queue means that the engine does not read; its silence will close the gate.
    if (engine_.send(hand_) == SocketEvent::Closed) {
        gate_.close();
        engine_.close();
    }
}

} // namespace fathom
