// SPDX-License-Identifier: Apache-2.0
// The ports of the kernel's virtual USB host controller, and waiting for conditions in the virtual machine.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

namespace fathom::vm {

// Number of a free port. Throws std::runtime_error with what is missing.
int freeVhciPort();

// Attaches the device; the kernel then uses the protocol on this socket. speed: 2 full, 3 high.
int attachVhci(int port, int speed);

// At most two seconds.
void waitUntilVhciFree(int port);

// Polls every 5 ms; true if the condition came true in time.
bool waitFor(const std::function<bool()>& condition,
             std::chrono::milliseconds most = std::chrono::milliseconds(5000));
bool waitForFile(const std::filesystem::path& file,
                 std::chrono::milliseconds most = std::chrono::milliseconds(5000));

} // namespace fathom::vm
