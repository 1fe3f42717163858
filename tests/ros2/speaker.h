// SPDX-License-Identifier: Apache-2.0
// A program that publishes lines of one topic.
#pragma once

#include "tests/ros2/peer.h"

#include <doctest/doctest.h>

class Speaker {
public:
    Speaker(const std::string& topic, const std::string& type)
        : peer_(ROS2_SPEAKER, {std::to_string(testDomain()), topic, type, "say"}) {
        REQUIRE(peer_.line() == "ready");
    }
    void say(const std::string& line) {
        peer_.send(line);
        REQUIRE(peer_.line() == "ok");
    }

private:
    Peer peer_;
};
