// SPDX-License-Identifier: Apache-2.0
// A request for a camera of a ROS 2 graph, in one line: "ros2:depth=TOPIC[,NAME=VALUE]...".
#pragma once

#include "devices/recorded/source_options.h"
#include "devices/ros2/ros2_place.h"

#include <string>

namespace fathom {

struct Ros2Request {
    std::string text; // as given, for messages
    Ros2Place place;
    SourceOptions options; // depth: never empty; colour: a topic or "none"
    std::string frame;     // in which tf gives the camera's pose; empty = the scene does
    double wait = 10.0;    // [s] for the first images
    double silence = 2.0;  // [s] without depth until the camera counts as lost
    bool everyFrame = false;

    static constexpr const char* kAllowed =
        "ros2:depth=TOPIC, then any of ,colour=TOPIC ,info=TOPIC ,intrinsics=FILE ,extrinsics=FILE "
        ",scale=M ,frame=NAME ,domain=N ,network=lo|INTERFACE|any ,wait=S";
};

// `text` with or without the leading "ros2:". Throws BadInput.
Ros2Request parseRos2Request(const std::string& text);

} // namespace fathom
