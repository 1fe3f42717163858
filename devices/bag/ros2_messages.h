// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2 as bytes (CDR), and their definitions.
#pragma once

#include "devices/bag/ros_messages.h"

#include <span>
#include <string>
#include <vector>

namespace fathom::ros2 {

// Header of every message.
struct Header {
    uint64_t time = 0; // [ns]
    std::string frame;
};
using Message = std::vector<uint8_t>;

// Rows without gaps, little-endian.
struct Picture {
    uint32_t width = 0, height = 0, bytesPerPixel = 0;
    std::string encoding;
    std::span<const uint8_t> bytes;
};
Message image(const Header& header, const Picture& picture);         // sensor_msgs/msg/Image
Message cameraInfo(const Header& header, const Intrinsics& lens);    // sensor_msgs/msg/CameraInfo
Message transform(const Header& header, const ros::FrameLink& link); // tf2_msgs/msg/TFMessage
Message transform(const Pose& pose);                                 // geometry_msgs/msg/Transform
Message extrinsics(const Pose& pose);                                // realsense2_camera_msgs/msg/Extrinsics
Message float32(float number);                                       // std_msgs/msg/Float32
Message pose(const Header& header, const Pose& pose);                // geometry_msgs/msg/PoseStamped
Message wrench(const Header& header, const dvec3& force, const dvec3& torque); // .../msg/WrenchStamped

// Points of sensor_msgs/msg/PointCloud2, all fields float32.
struct RegionPoint {
    float x = 0.0f, y = 0.0f, z = 0.0f, radius = 0.0f; // [m]
    float fixture = 0.0f;                              // class of the scene, from 0
};
Message regions(const Header& header, std::span<const RegionPoint> points);

// The definition of "sensor_msgs/msg/Image" and the like as the ros2msg encoding of MCAP has it, with those
// of the types that it uses. Of the types above.
std::string definition(const std::string& type);

} // namespace fathom::ros2
