// SPDX-License-Identifier: Apache-2.0
// A serial line: termios raw, 8N1, no flow control, never blocking (POSIX.1-2017 termios.h; Linux
// tty_ioctl(4)).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace fathom {

class SerialPort {
public:
    // baud: 9600, 19200, 38400, 57600, 115200, 230400. rs485: asks the kernel to switch the direction
    // (TIOCSRS485); adapters that do it by themselves refuse, which is logged and no error. Throws BadInput
    // (no such line, not allowed, no terminal, baud).
    SerialPort(const std::filesystem::path& device, uint32_t baud, bool rs485 = false);
    ~SerialPort();
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    // Bytes that were there, at most out.size(); 0 = none now, or the line is gone.
    size_t read(std::span<uint8_t> out) noexcept;
    // False when not all could be taken at once: the rest is dropped, the protocols recover.
    bool write(std::span<const uint8_t> bytes) noexcept;
    bool gone() const noexcept { return gone_; }      // unplugged, hung up
    int descriptor() const noexcept { return file_; } // stays this object's: for a process that inherits it

private:
    int file_ = -1;
    bool gone_ = false;
};

} // namespace fathom
