// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/view_socket.h"

#include <algorithm>

#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom {

namespace {

// Size [bytes] of the send queue, made as large as the system permits (net.core.wmem_max), up to 1 MiB.
int widenQueue(const DeviceSocket& end) noexcept {
    const int wanted = 1 << 20;
    ::setsockopt(end.descriptor(), SOL_SOCKET, SO_SNDBUF, &wanted, sizeof wanted);
    int got = 0;
    socklen_t size = sizeof got;
    ::getsockopt(end.descriptor(), SOL_SOCKET, SO_SNDBUF, &got, &size);
    return got;
}

// A system that cannot tell its use of the queue lets packets fill it.
bool halfEmpty(const DeviceSocket& end, int queue) noexcept {
    int used = 0;
    return ::ioctl(end.descriptor(), SIOCOUTQ, &used) != 0 || used <= queue / 2;
}

} // namespace

ViewSocket::ViewSocket(std::filesystem::path path)
    : path_(std::move(path))
    , endpoint_(DeviceSocket::listen(path_, static_cast<int>(kMax))) {}

ViewSocket::~ViewSocket() {
    ::unlink(path_.c_str());
}

bool ViewSocket::watched() const noexcept {
    return std::any_of(observers_.begin(), observers_.end(), [](const Observer& o) { return o.end.open(); });
}

void ViewSocket::poll() noexcept {
    for (DeviceSocket newcomer = endpoint_.accept(); newcomer.open(); newcomer = endpoint_.accept()) {
        for (Observer& place : observers_) {
            if (!place.end.open()) {
                place.queue = widenQueue(newcomer);
                place.end = std::move(newcomer);
                break;
            }
        } // no free slot: the new connection is closed
    }
}

template <class T>
SocketEvent ViewSocket::sendTo(Observer& observer, T& packet, uint16_t kind) noexcept {
    packet.header = socketHeader(kind, sizeof packet, observer.sequence + 1);
    return observer.end.send(packet);
}

// True once the observer has all of the newest list. Leaves a closed connection to the next state.
template <class T>
bool ViewSocket::proceed(Observer& observer, Progress<T>& progress, const List<T>& newest,
                         uint16_t kind) noexcept {
    for (;;) {
        if (progress.list == nullptr || progress.next == progress.list->size()) {
            if (progress.list == newest) {
                return true;
            }
            progress = {newest, 0};
            continue;
        }
        if (!halfEmpty(observer.end, observer.queue) ||
            sendTo(observer, (*progress.list)[progress.next], kind) != SocketEvent::Packet) {
            return false;
        }
        ++observer.sequence;
        ++progress.next;
    }
}

void ViewSocket::send(fathom_door_state& state) noexcept {
    for (Observer& observer : observers_) {
        if (!observer.end.open()) {
            continue;
        }
        const SocketEvent event = sendTo(observer, state, FATHOM_DOOR_STATE);
        if (event == SocketEvent::Closed) {
            observer = {};
            continue;
        }
        ++observer.sequence; // a lost state leaves a gap
        if (proceed(observer, observer.fixtures, fixtures_, FATHOM_DOOR_FIXTURES)) {
            proceed(observer, observer.regions, regions_, FATHOM_DOOR_REGIONS);
        }
    }
}

} // namespace fathom
