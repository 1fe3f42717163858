// SPDX-License-Identifier: Apache-2.0
// The bridge to a haptic device whose driver is a node of ROS 2: a hand socket to its topics. When the engine
// fails in any way, it publishes zero force.
#pragma once

#include "devices/bridge/socket_server.h"
#include "devices/ros2/ros2_hand_request.h"

#include <atomic>
#include <memory>

namespace fathom {

// Counters since the start.
struct Ros2BridgeFigures {
    uint64_t replies = 0; // poses
    uint64_t late = 0;    // poses over kLate after the one before
    uint64_t faults = 0;  // messages that were not usable
    uint64_t losses = 0;  // silences
};

// One thread. The node must render no force when it gets none for 10 ms: nothing else ends the force when
// this process dies.
class Ros2Bridge {
public:
    virtual ~Ros2Bridge() = default;
    // Publishes the force every kPeriod until `stop`, then zero. A device whose poses are missing for
    // kSilence counts as gone, and the engine is informed.
    virtual void run(const std::atomic<bool>& stop) = 0;

    virtual std::string place() const = 0;
    virtual const Ros2BridgeFigures& figures() const noexcept = 0;
    uint64_t losses() const noexcept { return figures().losses; }
    virtual const SocketServer& endpoint() const noexcept = 0;

    static constexpr double kPeriod = 0.001;   // [s]
    static constexpr double kLate = 0.02;      // [s]
    static constexpr double kSilence = 0.1;    // [s] of poses
    static constexpr double kJoySilence = 0.5; // [s] then a dead-man button counts as open
};

// endpoint: path of the socket; forceLimit [N], torqueLimit [N m]: of the preset. Throws BadInput: not built
// in, no Cyclone DDS, the socket or the network cannot be used.
std::unique_ptr<Ros2Bridge> openRos2Bridge(const Ros2HandRequest& request,
                                           const std::filesystem::path& endpoint, double forceLimit,
                                           double torqueLimit);

} // namespace fathom
