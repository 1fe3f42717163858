// SPDX-License-Identifier: Apache-2.0
// A client of a service, in a process of its own.
#pragma once

#include "tests/ros2/peer.h"

#include <doctest/doctest.h>
#include <string>

class Client {
public:
    // type: without its package. Returns when it has found the service.
    Client(const std::string& service, const std::string& type)
        : peer_(ROS2_CLIENT, {std::to_string(testDomain()), service, type, "call"}) {
        REQUIRE(peer_.line() == "ready");
    }
    // The reply: "NUMBER SUCCESS MESSAGE"; empty = none within a minute.
    std::string call(const std::string& line) {
        peer_.send(line);
        return peer_.line().value_or("");
    }

private:
    Peer peer_;
};
