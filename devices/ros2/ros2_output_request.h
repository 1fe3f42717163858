// SPDX-License-Identifier: Apache-2.0
// What of a run is published in a ROS 2 graph, in one line: "/PREFIX[,NAME=VALUE]...".
#pragma once

#include "devices/ros2/ros2_place.h"

#include <string>

namespace fathom {

// The parsed line.
struct Ros2OutputRequest {
    std::string prefix; // of the topics, e.g. "/fathom"
    Ros2Place place;
    std::string frame = "base"; // name of the base frame
    double rate = 250.0;        // [1/s] most messages per topic
    bool commands = false;      // others may switch forces off, guidance and freezing
    bool frames = false;        // poses of camera and tool go to /tf, too
    std::string twist;          // topic of the tool's velocity; empty = none
    std::string trajectory;     // topic of the arm's joints, for a robot; empty = none
    std::string measured;       // topic of that robot's joints

    static constexpr double kMaxRate = 1000.0;
    static constexpr const char* kAllowed =
        "/PREFIX, then any of ,frame=NAME ,rate=HZ ,tf=on ,commands=on ,twist=TOPIC ,trajectory=TOPIC "
        ",measured=TOPIC ,domain=N ,network=lo|INTERFACE|any";
};

// The domain is ros2Domain() if the text has none. Throws BadInput.
Ros2OutputRequest parseRos2OutputRequest(const std::string& text);

} // namespace fathom
