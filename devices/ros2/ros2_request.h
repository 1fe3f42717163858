// SPDX-License-Identifier: Apache-2.0
// A request for a camera of a ROS 2 graph, in one line: "ros2:depth=TOPIC[,NAME=VALUE]...".
#pragma once

#include "devices/recorded/source_options.h"

#include <cstdint>
#include <string>

namespace fathom {

// Where a ROS 2 graph is.
struct Ros2Place {
    uint32_t domain = 0; // 0 to 232
    // An interface's name, e.g. "eth0". "lo" is this machine only. "any": as CYCLONEDDS_URI or Cyclone
    // choose.
    std::string network = "lo";

    bool operator==(const Ros2Place&) const = default;
};

// The domain that the environment variable ROS_DOMAIN_ID gives, else 0. Throws BadInput.
uint32_t ros2Domain();

// "/camera/depth/image_raw" and the like. A leading slash is added where there is none. Throws BadInput.
std::string ros2Topic(const std::string& field, const std::string& name);

struct Ros2Request {
    std::string text; // as given, for messages
    Ros2Place place;
    SourceOptions options; // depth: never empty; colour: a topic or "none"
    double wait = 10.0;    // [s] for the first images
    double silence = 2.0;  // [s] without depth until the camera counts as lost
    bool everyFrame = false;

    static constexpr const char* kAllowed =
        "ros2:depth=TOPIC, then any of ,colour=TOPIC ,info=TOPIC ,intrinsics=FILE ,extrinsics=FILE "
        ",scale=M ,domain=N ,network=lo|INTERFACE|any ,wait=S";
};

// `text` with or without the leading "ros2:". Throws BadInput.
Ros2Request parseRos2Request(const std::string& text);

} // namespace fathom
