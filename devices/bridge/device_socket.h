// SPDX-License-Identifier: Apache-2.0
// One end of a door (fathom_door.h): an owned AF_UNIX SOCK_SEQPACKET descriptor that sends and receives whole
// packets and never waits.
#pragma once

#include "devices/bridge/fathom_door.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace fathom {

// CLOCK_MONOTONIC [ns], the clock of fathom_door_header.time_ns.
uint64_t socketClock() noexcept;

// Result of one send or receive.
enum class SocketEvent {
    Packet, // done
    Empty,  // nothing there, or no room: try again later
    Closed, // the other end is gone
    Bad,    // a packet of another size, magic, version or kind: the connection is to be dropped
};

// What is wrong with a received packet, in words for one line; empty when nothing. `got` bytes arrived.
std::string socketFault(const fathom_door_header& header, size_t got, uint16_t kind, size_t size);

// Move-only. All but connect() and listen() are noexcept, without waiting and allocation.
class DeviceSocket {
public:
    DeviceSocket() = default;
    explicit DeviceSocket(int descriptor) noexcept
        : descriptor_(descriptor) {}
    DeviceSocket(DeviceSocket&& other) noexcept
        : descriptor_(other.release()) {}
    DeviceSocket& operator=(DeviceSocket&& other) noexcept;
    ~DeviceSocket() { close(); }

    // To the door at `path`. Throws BadInput when nobody listens there or permission is missing; it says
    // which.
    static DeviceSocket connect(const std::filesystem::path& path);
    // The same; 0 or the error number.
    static int tryConnect(const std::filesystem::path& path, DeviceSocket& out) noexcept;
    // A door at `path` with permission 0600 from the start. A file left by a program that died is replaced.
    // Throws BadInput when some program listens there, the path is no socket or too long, or it cannot be
    // made.
    static DeviceSocket listen(const std::filesystem::path& path, int backlog);

    // Of a listening door: the next one who connected; empty when nobody did.
    DeviceSocket accept() noexcept;

    template <class T>
    SocketEvent send(const T& packet) noexcept {
        return sendBytes(&packet, sizeof packet);
    }
    // The oldest packet that waits. `got`: bytes that arrived, for socketFault().
    template <class T>
    SocketEvent receive(T& packet, uint16_t kind, size_t* got = nullptr) noexcept {
        size_t arrived = 0;
        const SocketEvent event = receiveBytes(&packet, sizeof packet, arrived);
        if (got != nullptr) {
            *got = arrived;
        }
        return event == SocketEvent::Packet && !fits(packet.header, arrived, kind, sizeof packet)
                   ? SocketEvent::Bad
                   : event;
    }

    void close() noexcept;
    bool open() const noexcept { return descriptor_ >= 0; }
    int descriptor() const noexcept { return descriptor_; }
    int release() noexcept;

private:
    static bool fits(const fathom_door_header& header, size_t got, uint16_t kind, size_t size) noexcept;
    SocketEvent sendBytes(const void* data, size_t size) noexcept;
    SocketEvent receiveBytes(void* data, size_t size, size_t& got) noexcept;

    int descriptor_ = -1;
};

// Header of the next packet of a direction.
inline fathom_door_header socketHeader(uint16_t kind, size_t size, uint64_t sequence) noexcept {
    return {FATHOM_DOOR_MAGIC, FATHOM_DOOR_VERSION, kind, static_cast<uint32_t>(size), 0,
            sequence,          socketClock()};
}

// $XDG_RUNTIME_DIR/fathom-NAME.door. Throws BadInput when that folder is not set: then a path must be given.
std::filesystem::path defaultEndpoint(const std::string& name);

} // namespace fathom
