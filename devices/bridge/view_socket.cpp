// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/view_socket.h"

#include <algorithm>

#include <unistd.h>

namespace fathom {

ViewSocket::ViewSocket(std::filesystem::path path)
    : path_(std::move(path))
    , endpoint_(DeviceSocket::listen(path_, static_cast<int>(kMax))) {}

ViewSocket::~ViewSocket() {
    ::unlink(path_.c_str());
}

bool ViewSocket::watched() const noexcept {
    return std::any_of(observers_.begin(), observers_.end(), [](const DeviceSocket& o) { return o.open(); });
}

bool ViewSocket::poll() noexcept {
    bool any = false;
    for (DeviceSocket newcomer = endpoint_.accept(); newcomer.open(); newcomer = endpoint_.accept()) {
        for (DeviceSocket& place : observers_) {
            if (!place.open()) {
                place = std::move(newcomer);
                any = true;
                break;
            }
        } // no free slot: the new connection is closed
    }
    return any;
}

template <class T>
void ViewSocket::sendAll(T& packet, uint16_t kind) noexcept {
    packet.header = socketHeader(kind, sizeof packet, ++sent_);
    for (DeviceSocket& observer : observers_) {
        if (!observer.open()) {
            continue;
        }
        switch (observer.send(packet)) {
        case SocketEvent::Packet:
            break;
        case SocketEvent::Empty:
            ++lost_;
            break;
        default:
            observer.close();
        }
    }
}

template void ViewSocket::sendAll(fathom_door_state&, uint16_t) noexcept;
template void ViewSocket::sendAll(fathom_door_regions&, uint16_t) noexcept;
template void ViewSocket::sendAll(fathom_door_fixtures&, uint16_t) noexcept;

} // namespace fathom
