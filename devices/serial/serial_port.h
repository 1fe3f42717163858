// SPDX-License-Identifier: Apache-2.0
// A serial port: termios raw, 8N1, no flow control, non-blocking (POSIX.1-2017 termios.h; Linux
// tty_ioctl(4)).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace fathom {

class SerialPort {
public:
    // baud: 9600, 19200, 38400, 57600, 115200, 230400. rs485: asks the kernel to switch the direction
    // (TIOCSRS485); adapters with automatic direction control reject the call, which is logged but is not an
    // error. Throws BadInput for a missing port, missing permission, a device that is not a terminal, or an
    // invalid baud rate.
    SerialPort(const std::filesystem::path& device, uint32_t baud, bool rs485 = false);
    ~SerialPort();
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    // Returns the number of bytes read, at most out.size(); 0 = none pending, or the port is lost.
    size_t read(std::span<uint8_t> out) noexcept;
    // False when not all bytes could be written; the rest is dropped, the protocols recover.
    bool write(std::span<const uint8_t> bytes) noexcept;
    bool gone() const noexcept { return gone_; }      // unplugged, hung up
    int descriptor() const noexcept { return file_; } // owned by this object; for a process that inherits it

private:
    int file_ = -1;
    bool gone_ = false;
};

// Reads pending bytes. Calls handle(packet) for each packet that they complete in `reader`.
template <class Reader, class Handler>
void readPackets(SerialPort& port, Reader& reader, const Handler& handle) {
    std::array<uint8_t, 256> bytes{};
    size_t got = 0;
    do {
        got = port.read(bytes);
        for (size_t i = 0; i < got; ++i) {
            if (const auto packet = reader.take(bytes[i])) {
                handle(*packet);
            }
        }
    } while (got > 0);
}

} // namespace fathom
