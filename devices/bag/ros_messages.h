// SPDX-License-Identifier: Apache-2.0
// Parsers for the ROS 1 messages of a depth camera's bag. Source: the .msg definitions of
// sensor_msgs, geometry_msgs and std_msgs.
#pragma once

#include "engine/types/camera_info.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace fathom::ros {

// All throw Error when the message is truncated or invalid.

// sensor_msgs/Image; a view into the message.
struct Image {
    double stamp = 0.0; // [s]
    std::string frame, encoding;
    uint32_t width = 0, height = 0, step = 0; // [pixels], [bytes] per row
    bool bigEndian = false;
    std::span<const uint8_t> data; // of the message's bytes
};
Image image(std::span<const uint8_t> message); // sensor_msgs/Image

Intrinsics cameraInfo(std::span<const uint8_t> message); // sensor_msgs/CameraInfo; plumb_bob or no distortion
Pose transform(std::span<const uint8_t> message);        // geometry_msgs/Transform
float float32(std::span<const uint8_t> message);         // std_msgs/Float32

bool isDepth(const std::string& encoding);  // 16UC1, mono16 (as RealSense writes), 32FC1
bool isColour(const std::string& encoding); // rgb8, bgr8, rgba8, bgra8, yuv422_yuy2, mono8

// Both return the fault, or empty when everything was converted. Metres (32FC1) become units of 1 mm.
std::string depthRows(const Image& image, std::span<uint16_t> out);
std::string colourRows(const Image& image, std::span<uint32_t> out);

} // namespace fathom::ros
