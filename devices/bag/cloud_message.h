// SPDX-License-Identifier: Apache-2.0
// sensor_msgs/PointCloud2 as an organised cloud.
#pragma once

#include "devices/bag/message_cursor.h"
#include "devices/pcd/pcd_file.h"

#include <string>
#include <vector>

namespace fathom::ros {

// Type name of the message.
inline constexpr const char* kCloudType = "sensor_msgs/PointCloud2";

// A view into the message, whose memory it keeps.
struct Cloud {
    // One value of each point, for example x.
    struct Field {
        std::string name;
        uint32_t offset = 0, count = 0; // [bytes] in a point, values
        uint8_t type = 0;               // of sensor_msgs/PointField
    };
    std::string frame;
    uint32_t width = 0, height = 0, pointStep = 0, rowStep = 0; // points, [bytes]
    bool bigEndian = false;
    std::vector<Field> fields;
    std::span<const uint8_t> data;
    std::shared_ptr<const void> memory; // as MessageCursor::memory()

    const Field* find(const std::string& name) const;
    // "640x480 points of x y z rgb, frame 'camera'".
    std::string words() const;
};

// Throws Error when the message is truncated or has more than 64 fields.
Cloud cloud(MessageCursor message);

// Why it is not played, with what is allowed; empty = it can be: 2 to 3840 columns, 2 to 2160 rows, x, y and
// z as float32 that lie inside of the points, all points inside of the data.
std::string whyNoDepth(const Cloud& cloud);
// The points in row-major order, with colour from the field rgb or rgba (four bytes, 0xAARRGGBB). Only where
// whyNoDepth() is empty.
PcdCloud pointsOf(const Cloud& cloud);

} // namespace fathom::ros
