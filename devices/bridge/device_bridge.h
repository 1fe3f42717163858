// SPDX-License-Identifier: Apache-2.0
// The loop of a bridge: exchanges with its device and serves the engine, also while the device is lost.
#pragma once

#include "devices/bridge/socket_server.h"

#include <atomic>
#include <optional>
#include <string>

namespace fathom {

// One thread. The constructor of a derived class opens the device and listens; its destructor closes the
// device.
class DeviceBridge {
public:
    virtual ~DeviceBridge() = default;
    DeviceBridge(const DeviceBridge&) = delete;
    DeviceBridge& operator=(const DeviceBridge&) = delete;

    // Runs until `stop`, then sends zero force. A lost device is searched four times per second, and the
    // engine is informed meanwhile.
    void run(const std::atomic<bool>& stop);

    uint64_t losses() const noexcept { return losses_; }
    const SocketServer& endpoint() const noexcept { return *endpoint_; }

protected:
    // label: begins each log line.
    explicit DeviceBridge(std::string label)
        : label_(std::move(label)) {}

    // Longest wait for an answer of the device, before the socket is polled again.
    static constexpr auto kWait = std::chrono::milliseconds(1);

    std::optional<SocketServer> endpoint_; // set by the derived constructor
    HandSample sample_;                    // the newest; repeated while the device is lost
    uint64_t losses_ = 0;

private:
    // Reopens a lost device. Throws Error while it is absent or not ready.
    virtual void open() = 0;
    virtual bool isOpen() const noexcept = 0;
    // Sends zero force and closes the device, if it is open.
    virtual void close() noexcept = 0;
    // Polls the socket, and exchanges a force for a sample. Throws DeviceLost.
    virtual void exchange() = 0;

    void waitForDevice(const std::atomic<bool>& stop);

    std::string label_;
};

} // namespace fathom
