// SPDX-License-Identifier: Apache-2.0
// Bringing a Falcon to life after power-on. The firmware is Novint's: the user names a file, none is shipped.
#pragma once

#include "devices/usb/ftdi_port.h"

#include <filesystem>

namespace fathom {

// Throws BadInput: no such file, empty, or over 64 KiB.
std::vector<uint8_t> readFalconFirmware(const std::filesystem::path& file);

// Hands the firmware to the boot loader: 9600 Bd greeting, then 140 kBd, every piece of at most 62 bytes
// echoed back. Throws Error that names the step and what came instead; DeviceLost. Takes some seconds.
void loadFalconFirmware(FtdiPort& port, std::span<const uint8_t> firmware);

// The line of a running firmware: 1.5 MBd, 1 ms latency, nothing left in either queue.
void setFalconLine(FtdiPort& port);

} // namespace fathom
