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
uint64_t doorClock() noexcept;

// Result of one send or receive.
enum class DoorEvent {
    Packet, // done
    Empty,  // nothing there, or no room: try again later
    Closed, // the other end is gone
    Bad,    // a packet of another size, magic, version or kind: the connection is to be dropped
};

// What is wrong with a received packet, in words for one line; empty when nothing. `got` bytes arrived.
std::string doorFault(const fathom_door_header& header, size_t got, uint16_t kind, size_t size);

// Move-only. All but connect() and listen() are noexcept, without waiting and allocation.
class DoorSocket {
public:
    DoorSocket() = default;
    explicit DoorSocket(int descriptor) noexcept
        : descriptor_(descriptor) {}
    DoorSocket(DoorSocket&& other) noexcept
        : descriptor_(other.release()) {}
    DoorSocket& operator=(DoorSocket&& other) noexcept;
    ~DoorSocket() { close(); }

    // To the door at `path`. Throws BadInput when nobody listens there or permission is missing; it says
    // which.
    static DoorSocket connect(const std::filesystem::path& path);
    // The same; 0 or the error number.
    static int tryConnect(const std::filesystem::path& path, DoorSocket& out) noexcept;
    // A door at `path` with permission 0600 from the start. A file left by a program that died is replaced.
    // Throws BadInput when some program listens there, the path is no socket or too long, or it cannot be
    // made.
    static DoorSocket listen(const std::filesystem::path& path, int backlog);

    // Of a listening door: the next one who connected; empty when nobody did.
    DoorSocket accept() noexcept;

    template <class T>
    DoorEvent send(const T& packet) noexcept {
        return sendBytes(&packet, sizeof packet);
    }
    // The oldest packet that waits. `got`: bytes that arrived, for doorFault().
    template <class T>
    DoorEvent receive(T& packet, uint16_t kind, size_t* got = nullptr) noexcept {
        size_t arrived = 0;
        const DoorEvent event = receiveBytes(&packet, sizeof packet, arrived);
        if (got != nullptr) {
            *got = arrived;
        }
        return event == DoorEvent::Packet && !fits(packet.header, arrived, kind, sizeof packet)
                   ? DoorEvent::Bad
                   : event;
    }

    void close() noexcept;
    bool open() const noexcept { return descriptor_ >= 0; }
    int descriptor() const noexcept { return descriptor_; }
    int release() noexcept;

private:
    static bool fits(const fathom_door_header& header, size_t got, uint16_t kind, size_t size) noexcept;
    DoorEvent sendBytes(const void* data, size_t size) noexcept;
    DoorEvent receiveBytes(void* data, size_t size, size_t& got) noexcept;

    int descriptor_ = -1;
};

// Header of the next packet of a direction.
inline fathom_door_header doorHeader(uint16_t kind, size_t size, uint64_t sequence) noexcept {
    return {FATHOM_DOOR_MAGIC, FATHOM_DOOR_VERSION, kind, static_cast<uint32_t>(size), 0,
            sequence,          doorClock()};
}

// $XDG_RUNTIME_DIR/fathom-NAME.door. Throws BadInput when that folder is not set: then a path must be given.
std::filesystem::path defaultDoor(const std::string& name);

} // namespace fathom
