// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2 as bytes (CDR), and their definitions.
#pragma once

#include "devices/bag/ros_messages.h"

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fathom::ros2 {

// Header of every message.
struct Header {
    uint64_t time = 0; // [ns]
    std::string frame;
};
using Message = std::vector<uint8_t>;

// Rows without gaps, little-endian.
struct ImageData {
    uint32_t width = 0, height = 0, bytesPerPixel = 0;
    std::string encoding;
    std::span<const uint8_t> bytes;
};
Message image(const Header& header, const ImageData& data);          // sensor_msgs/msg/Image
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

Message twist(const Header& header, const dvec3& linear, const dvec3& angular); // geometry_msgs TwistStamped

// Positions [rad] or [m] of joints in the order of their names: sensor_msgs/msg/JointState, and
// trajectory_msgs/msg/JointTrajectory of one point that is reached after `seconds`.
using Names = std::span<const std::string>;
Message jointState(const Header& header, Names names, std::span<const double> positions);
Message trajectory(const Header& header, Names names, std::span<const double> positions, double seconds);

// Of diagnostic_msgs/msg/DiagnosticArray.
struct Diagnosis {
    enum class Level : uint8_t { Ok, Warning, Error, Stale };
    Level level = Level::Ok;
    std::string name, message;
    std::vector<std::pair<std::string, std::string>> values;
};
Message diagnostics(const Header& header, std::span<const Diagnosis> parts);

// Of visualization_msgs/msg/MarkerArray as it is since ROS 2 Galactic.
struct Marker {
    enum class Kind : int32_t { Arrow, Cube, Sphere, Cylinder, SphereList = 7 };
    enum class Action : int32_t { Add = 0, DeleteAll = 3 };
    std::string space; // id counts within it
    int32_t id = 0;
    Kind kind = Kind::Sphere;
    Action action = Action::Add;
    Pose pose;
    dvec3 scale{1.0};               // [m]
    std::array<float, 4> colour{};  // red, green, blue, alpha: 0 to 1
    std::vector<dvec3> points = {}; // [m] centres of a list, relative to `pose`
};
Message markers(const Header& header, std::span<const Marker> markers);

// The definition of "sensor_msgs/msg/Image" and the like as the ros2msg encoding of MCAP has it, with those
// of the types that it uses. Of the types above.
std::string definition(const std::string& type);

} // namespace fathom::ros2
