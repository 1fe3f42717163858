// SPDX-License-Identifier: Apache-2.0
// One end of a device socket (fathom/device_socket.h): owns an AF_UNIX SOCK_SEQPACKET descriptor, sends and
// receives whole packets, never blocks.
#pragma once

#include "engine/include/fathom/device_socket.h"

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
    Empty,  // no packet, or the queue is full: try again later
    Closed, // the peer has closed
    Bad,    // wrong size, magic, version or kind: drop the connection
};

// What is wrong with a received packet; empty when it is valid.
struct SocketFault {
    std::string found, allowed;

    bool empty() const { return found.empty(); }
    std::string text() const; // one line
};
// got: bytes received.
SocketFault socketFault(const fathom_door_header& header, size_t got, uint16_t kind, size_t size);

// Move-only. All members but connect() and listen() are noexcept and neither block nor allocate.
class DeviceSocket {
public:
    DeviceSocket() = default;
    explicit DeviceSocket(int descriptor) noexcept
        : descriptor_(descriptor) {}
    DeviceSocket(DeviceSocket&& other) noexcept
        : descriptor_(other.release()) {}
    DeviceSocket& operator=(DeviceSocket&& other) noexcept;
    ~DeviceSocket() { close(); }

    // Connects to the socket at `path`. Throws BadInput when there is no listener or no permission.
    static DeviceSocket connect(const std::filesystem::path& path);
    // The same, but returns 0 or errno.
    static int tryConnect(const std::filesystem::path& path, DeviceSocket& out) noexcept;
    // Listens at `path`, with permission 0600 from the start. Replaces a stale socket file. Throws BadInput
    // when another program listens there, the path is not a socket or is too long, or the socket cannot be
    // created.
    static DeviceSocket listen(const std::filesystem::path& path, int backlog);

    // Listening socket: the next pending connection; empty when there is none.
    DeviceSocket accept() noexcept;

    template <class T>
    SocketEvent send(const T& packet) noexcept {
        return sendBytes(&packet, sizeof packet);
    }
    // The oldest pending packet. `got`: bytes received, for socketFault().
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

// Header of the next packet to send.
inline fathom_door_header socketHeader(uint16_t kind, size_t size, uint64_t sequence) noexcept {
    return {FATHOM_DOOR_MAGIC, FATHOM_DOOR_VERSION, kind, static_cast<uint32_t>(size), 0,
            sequence,          socketClock()};
}

// $XDG_RUNTIME_DIR/fathom-NAME.door. Throws BadInput when that variable is not set; the user must then give a
// path, as `instead` says.
std::filesystem::path defaultEndpoint(const std::string& name, const std::string& instead);

} // namespace fathom
