// SPDX-License-Identifier: Apache-2.0
// Definitions of messages without their comments. Source: common_interfaces, rcl_interfaces and geometry2 of
// ROS 2.
#include "devices/bag/ros2_messages.h"

#include <map>
#include <vector>

namespace fathom::ros2 {

namespace {

struct Definition {
    const char* text;
    std::vector<const char*> uses; // all, in any depth
};

const std::map<std::string, const char*> kParts{
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/Wrench", "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n"},
    {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    {"sensor_msgs/PointField", "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
                               "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\n"
                               "uint32 offset\nuint8 datatype\nuint32 count\n"}};

const std::map<std::string, Definition> kDefinitions{
    {"sensor_msgs/msg/Image",
     {"std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
      "uint32 step\nuint8[] data\n",
      {"std_msgs/Header", "builtin_interfaces/Time"}}},
    {"sensor_msgs/msg/CameraInfo",
     {"std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
      "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
      "sensor_msgs/RegionOfInterest roi\n",
      {"std_msgs/Header", "builtin_interfaces/Time", "sensor_msgs/RegionOfInterest"}}},
    {"tf2_msgs/msg/TFMessage",
     {"geometry_msgs/TransformStamped[] transforms\n",
      {"geometry_msgs/TransformStamped", "std_msgs/Header", "builtin_interfaces/Time",
       "geometry_msgs/Transform", "geometry_msgs/Vector3", "geometry_msgs/Quaternion"}}},
    {"geometry_msgs/msg/PoseStamped",
     {"std_msgs/Header header\ngeometry_msgs/Pose pose\n",
      {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Pose", "geometry_msgs/Point",
       "geometry_msgs/Quaternion"}}},
    {"geometry_msgs/msg/WrenchStamped",
     {"std_msgs/Header header\ngeometry_msgs/Wrench wrench\n",
      {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Wrench", "geometry_msgs/Vector3"}}},
    {"sensor_msgs/msg/PointCloud2",
     {"std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
      "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
      {"std_msgs/Header", "builtin_interfaces/Time", "sensor_msgs/PointField"}}}};

} // namespace

std::string definition(const std::string& type) {
    const Definition& whole = kDefinitions.at(type);
    std::string text = whole.text;
    for (const char* used : whole.uses) {
        text += std::string(80, '=') + "\nMSG: " + used + "\n" + kParts.at(used);
    }
    return text;
}

} // namespace fathom::ros2
