// SPDX-License-Identifier: Apache-2.0
// Loads the firmware of a Falcon after power-on. The firmware is Novint's: the user names a file, none is
// shipped.
#pragma once

#include "devices/usb/ftdi_port.h"

#include <filesystem>

namespace fathom {

// Throws BadInput for a file that is missing, empty or over 64 KiB.
std::vector<uint8_t> readFalconFirmware(const std::filesystem::path& file);

// Sends the firmware to the boot loader: greeting at 9600 Bd, then 140 kBd; each chunk of at most 62 bytes is
// echoed. Throws Error that names the step and the answer, or DeviceLost. Takes some seconds.
void loadFalconFirmware(FtdiPort& port, std::span<const uint8_t> firmware);

// Configures the port for running firmware: 1.5 MBd, 1 ms latency, empty queues.
void setFalconLine(FtdiPort& port);

} // namespace fathom
