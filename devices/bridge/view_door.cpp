// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/view_door.h"

#include <algorithm>

#include <unistd.h>

namespace fathom {

ViewDoor::ViewDoor(std::filesystem::path path)
    : path_(std::move(path))
    , door_(DoorSocket::listen(path_, static_cast<int>(kMost))) {}

ViewDoor::~ViewDoor() {
    ::unlink(path_.c_str());
}

bool ViewDoor::watched() const noexcept {
    return std::any_of(observers_.begin(), observers_.end(), [](const DoorSocket& o) { return o.open(); });
}

bool ViewDoor::poll() noexcept {
    bool any = false;
    for (DoorSocket newcomer = door_.accept(); newcomer.open(); newcomer = door_.accept()) {
        for (DoorSocket& place : observers_) {
            if (!place.open()) {
                place = std::move(newcomer);
                any = true;
                break;
            }
        } // no place: the newcomer is closed
    }
    return any;
}

template <class T>
void ViewDoor::sendAll(T& packet, uint16_t kind) noexcept {
    packet.header = doorHeader(kind, sizeof packet, ++sent_);
    for (DoorSocket& observer : observers_) {
        if (!observer.open()) {
            continue;
        }
        switch (observer.send(packet)) {
        case DoorEvent::Packet:
            break;
        case DoorEvent::Empty:
            ++lost_;
            break;
        default:
            observer.close();
        }
    }
}

template void ViewDoor::sendAll(fathom_door_state&, uint16_t) noexcept;
template void ViewDoor::sendAll(fathom_door_regions&, uint16_t) noexcept;
template void ViewDoor::sendAll(fathom_door_fixtures&, uint16_t) noexcept;

} // namespace fathom
