// SPDX-License-Identifier: Apache-2.0
// An FTDI serial converter as the Falcon uses one: control requests, bytes out, bytes in.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Vendor requests of an FT232R (device request type 0x40, no data).
enum class FtdiRequest : uint8_t {
    Reset = 0, // value 0 all, 1 purge what it received for us, 2 purge what we sent
    Modem = 1, // 0x0101 DTR high, 0x0100 DTR low, 0x0200 RTS low
    Flow = 2,
    Baud = 3,    // divisor of 3 MBd
    Data = 4,    // 8 = 8N1
    Latency = 9, // [ms] until bytes that wait are sent
};

// One thread. Every function throws DeviceLost once the device is gone.
class FtdiPort {
public:
    virtual ~FtdiPort() = default;
    virtual void control(FtdiRequest request, uint16_t value) = 0;
    // Starts sending at most 64 bytes. False while the previous bytes are in flight.
    virtual bool send(std::span<const uint8_t> bytes) = 0;
    // Waits until data arrived or was sent, at most this long.
    virtual void wait(std::chrono::microseconds most) = 0;
    // Appends the bytes received since the last call, without the modem status of each USB packet.
    virtual void take(std::vector<uint8_t>& bytes) = 0;
};

} // namespace fathom
