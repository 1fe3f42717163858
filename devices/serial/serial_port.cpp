// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/serial_port.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace fathom {

namespace {

speed_t speedOf(const std::filesystem::path& device, uint32_t baud) {
    switch (baud) {
    case 9600:
        return B9600;
    case 19200:
        return B19200;
    case 38400:
        return B38400;
    case 57600:
        return B57600;
    case 115200:
        return B115200;
    case 230400:
        return B230400;
    default:
        throw BadInput(device.string(), "baud", std::to_string(baud),
                       "9600, 19200, 38400, 57600, 115200, 230400");
    }
}

bool makeRaw(int file, speed_t speed) {
    termios settings{};
    if (tcgetattr(file, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
    settings.c_cc[VMIN] = 0;
    settings.c_cc[VTIME] = 0;
    return cfsetspeed(&settings, speed) == 0 && tcsetattr(file, TCSANOW, &settings) == 0 &&
           tcflush(file, TCIOFLUSH) == 0;
}

} // namespace

SerialPort::SerialPort(const std::filesystem::path& device, uint32_t baud, bool rs485) {
    const speed_t speed = speedOf(device, baud);
    file_ = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) {
        throw BadInput(device.string(), "serial line", std::strerror(errno), "an accessible serial device");
    }
    if (!makeRaw(file_, speed)) {
        const std::string why = std::strerror(errno);
        ::close(file_);
        throw BadInput(device.string(), "serial line", why, "a terminal device");
    }
    if (rs485) {
        serial_rs485 direction{};
        direction.flags = SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND;
        if (ioctl(file_, TIOCSRS485, &direction) != 0) {
            log::info("{}: no RS-485 direction control ({}); the adapter must switch by itself",
                      device.string(), std::strerror(errno));
        }
    }
}

SerialPort::~SerialPort() {
    ::close(file_);
}

size_t SerialPort::read(std::span<uint8_t> out) noexcept {
    const ssize_t got = ::read(file_, out.data(), out.size());
    gone_ = gone_ || (got < 0 && errno != EAGAIN && errno != EINTR);
    return got > 0 ? static_cast<size_t>(got) : 0;
}

bool SerialPort::write(std::span<const uint8_t> bytes) noexcept {
    const ssize_t sent = ::write(file_, bytes.data(), bytes.size());
    gone_ = gone_ || (sent < 0 && errno != EAGAIN && errno != EINTR);
    return sent == static_cast<ssize_t>(bytes.size());
}

} // namespace fathom
