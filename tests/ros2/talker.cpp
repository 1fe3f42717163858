// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/talker.h"

#include <doctest/doctest.h>

Talker::Talker()
    : peer_(ROS2_TALKER, {std::to_string(testDomain())}) {
    awaitOk();
}

void Talker::awaitOk() {
    REQUIRE(peer_.line() == "ok");
}

void Talker::set(const std::string& key, double value) {
    peer_.send(key + " " + std::to_string(value));
    awaitOk();
}

fathom::Ros2Request requestCamera(const std::string& more) {
    return fathom::parseRos2Request(
        "ros2:depth=/camera/depth/image_rect_raw,domain=" + std::to_string(testDomain()) + ",wait=60" + more);
}
