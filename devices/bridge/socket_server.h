// SPDX-License-Identifier: Apache-2.0
// The bridge's end of a hand socket: one engine at a time, samples out, wrenches in through the force gate.
#pragma once

#include "devices/bridge/device_socket.h"
#include "devices/bridge/force_gate.h"
#include "engine/types/haptic_device.h"

#include <filesystem>
#include <string>

namespace fathom {

// One thread. Listens from construction on; the destructor removes the socket file.
class SocketServer {
public:
    // Name of the device, and the limits of every wrench that it gets.
    struct Options {
        std::filesystem::path path;
        std::string preset; // of engine/haptics/device_preset.h
        std::string name;   // for display
        double forceLimit;  // [N]
        double torqueLimit; // [N m]
    };
    // Throws BadInput (DeviceSocket::listen).
    explicit SocketServer(const Options& options);
    SocketServer(const SocketServer&) = delete;
    SocketServer& operator=(const SocketServer&) = delete;
    ~SocketServer();

    // Reads all pending wrenches, then accepts one pending connection. Drops an engine that breaks the
    // contract and rejects a second one. Never blocks; logs connects and disconnects.
    void poll();

    // Sends a sample to the engine, if there is one. status: FATHOM_DOOR_PRESENT, FATHOM_DOOR_HOMED.
    void send(const HandSample& sample, uint32_t status) noexcept;

    // The wrench to render now.
    Wrench wrench() const noexcept { return gate_.at(socketClock()); }
    bool hasEngine() const noexcept { return engine_.open(); }
    const ForceGate& gate() const noexcept { return gate_; }
    // For poll(2): readable on a new connection.
    int descriptor() const noexcept { return endpoint_.descriptor(); }
    uint64_t dropped() const noexcept { return dropped_; } // engines that broke the contract
    const std::filesystem::path& path() const noexcept { return path_; }

private:
    void takeNewcomer();
    void takeWrenches();
    void drop(const std::string& why);

    std::filesystem::path path_;
    DeviceSocket endpoint_, engine_;
    ForceGate gate_;
    fathom_door_hand hand_{};
    uint64_t sent_ = 0, dropped_ = 0;
};

} // namespace fathom
