// SPDX-License-Identifier: Apache-2.0
// The bridge of a haptic device on a thread of its own, and its engine, which pushes with 2 N along z.
#pragma once

#include "devices/bridge/socket_hand.h"
#include "devices/ros2/ros2_bridge.h"
#include "tests/devices/socket_rig.h"
#include "tests/ros2/speaker.h"

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

struct BridgeLoop {
    explicit BridgeLoop(const std::string& pose, const std::string& more = "")
        : bridge(fathom::openRos2Bridge(
              fathom::parseRos2HandRequest("pose=" + pose +
                                           ",preset=falcon,domain=" + std::to_string(testDomain()) + more),
              folder.endpoint(), 8.0, 0.2))
        , thread([this] { bridge->run(stop); })
        , hand(folder.endpoint(), 4) {}
    ~BridgeLoop() {
        stop = true;
        thread.join();
    }
    // The node says `line`, unless one of them is missing, and the engine steps, until `wanted`.
    bool until(Speaker* node, const std::string& line,
               const std::function<bool(const fathom::HandSample&)>& wanted) {
        return fathom::testing::eventually(
            [&] {
                if (node != nullptr && !line.empty()) {
                    node->say(line);
                }
                const fathom::HandSample sample = hand.read(t += 0.001);
                hand.write({{0.0, 0.0, 2.0}, {}}, 0.001);
                fathom::testing::pauseMs(1);
                return wanted(sample);
            },
            60);
    }

    fathom::testing::SocketFolder folder;
    std::unique_ptr<fathom::Ros2Bridge> bridge;
    std::atomic<bool> stop{false};
    std::thread thread;
    fathom::SocketHand hand;
    double t = 0.0;
};
