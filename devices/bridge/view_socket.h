// SPDX-License-Identifier: Apache-2.0
// The engine's view socket: streams the state to up to four observers and waits for none of them.
#pragma once

#include "devices/bridge/device_socket.h"

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

namespace fathom {

// One thread, never the haptic one. Listens from construction on; the destructor removes the socket file.
class ViewSocket {
public:
    // Packets that belong together, such as the regions of a set. The socket fills in their headers.
    template <class T>
    using List = std::shared_ptr<std::vector<T>>;

    // Throws BadInput (DeviceSocket::listen).
    explicit ViewSocket(std::filesystem::path path);
    ViewSocket(const ViewSocket&) = delete;
    ViewSocket& operator=(const ViewSocket&) = delete;
    ~ViewSocket();

    // Accepts pending connections. A new observer gets the newest lists.
    void poll() noexcept;

    // Replaces the newest list; null = there is none. An observer gets each list that it has begun to the
    // end, and then the newest one, so at most kMax + 1 lists of a kind are kept.
    void offer(List<fathom_door_regions> regions) noexcept { regions_ = std::move(regions); }
    void offer(List<fathom_door_fixtures> fixtures) noexcept { fixtures_ = std::move(fixtures); }

    // Sends the state to every observer, and then as much of its lists as half of its queue takes: the other
    // half keeps states from being lost. An observer with a full queue loses the state; one that has
    // disconnected is removed.
    void send(fathom_door_state& state) noexcept;

    bool watched() const noexcept;

    static constexpr size_t kMax = 4;

private:
    template <class T>
    struct Progress {
        List<T> list;
        size_t next = 0; // packet to send
    };
    struct Observer {
        DeviceSocket end;
        int queue = 0; // [bytes] size of its queue
        uint64_t sequence = 0;
        Progress<fathom_door_regions> regions;
        Progress<fathom_door_fixtures> fixtures;
    };

    template <class T>
    static SocketEvent sendTo(Observer& observer, T& packet, uint16_t kind) noexcept;
    template <class T>
    static bool proceed(Observer& observer, Progress<T>& progress, const List<T>& newest,
                        uint16_t kind) noexcept;

    std::filesystem::path path_;
    DeviceSocket endpoint_;
    std::array<Observer, kMax> observers_;
    List<fathom_door_regions> regions_;   // newest
    List<fathom_door_fixtures> fixtures_; // newest
};

} // namespace fathom
