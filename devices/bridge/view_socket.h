// SPDX-License-Identifier: Apache-2.0
// The engine's view socket: streams the state to up to four observers and waits for none of them.
#pragma once

#include "devices/bridge/device_socket.h"

#include <array>
#include <filesystem>

namespace fathom {

// One thread, never the haptic one. Listens from construction on; the destructor removes the socket file.
class ViewSocket {
public:
    // Throws BadInput (DeviceSocket::listen).
    explicit ViewSocket(std::filesystem::path path);
    ViewSocket(const ViewSocket&) = delete;
    ViewSocket& operator=(const ViewSocket&) = delete;
    ~ViewSocket();

    // Accepts pending connections; true when there is a new observer, which has no regions and fixtures yet.
    bool poll() noexcept;

    // Sends to every observer and fills in the header. An observer with a full queue loses the packet; one
    // that has disconnected is removed.
    void send(fathom_door_state& state) noexcept { sendAll(state, FATHOM_DOOR_STATE); }
    void send(fathom_door_regions& regions) noexcept { sendAll(regions, FATHOM_DOOR_REGIONS); }
    void send(fathom_door_fixtures& fixtures) noexcept { sendAll(fixtures, FATHOM_DOOR_FIXTURES); }

    bool watched() const noexcept;
    uint64_t lost() const noexcept { return lost_; } // packets, over all observers

    static constexpr size_t kMax = 4;

private:
    template <class T>
    void sendAll(T& packet, uint16_t kind) noexcept;

    std::filesystem::path path_;
    DeviceSocket endpoint_;
    std::array<DeviceSocket, kMax> observers_;
    uint64_t sent_ = 0, lost_ = 0;
};

} // namespace fathom
