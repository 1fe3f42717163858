// SPDX-License-Identifier: Apache-2.0
// The ports of the kernel's virtual USB host controller, and what a test in the virtual machine waits for.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

namespace fathom::vm {

// Number of a port without a device. Throws std::runtime_error that says what is missing.
int freeVhciPort();

// Plugs: the socket on which the kernel now speaks the protocol. speed: 2 full, 3 high.
int attachVhci(int port, int speed);

// At most two seconds.
void waitUntilVhciFree(int port);

// Asks every 5 ms; whether it came true in time.
bool waitFor(const std::function<bool()>& condition,
             std::chrono::milliseconds most = std::chrono::milliseconds(5000));
bool waitForFile(const std::filesystem::path& file,
                 std::chrono::milliseconds most = std::chrono::milliseconds(5000));

} // namespace fathom::vm
