// SPDX-License-Identifier: Apache-2.0
// sensor_msgs/PointCloud2 as an organised cloud.
#pragma once

#include "devices/bag/message_cursor.h"
#include "devices/images/byte_order.h"
#include "devices/pcd/pcd_field.h"
#include "devices/pcd/pcd_file.h"

#include <string>
#include <vector>

namespace fathom::ros {

// Type name of the message.
inline constexpr const char* kCloudType = "sensor_msgs/PointCloud2";

// A view into the message, whose memory it keeps.
struct Cloud {
    std::string frame;
    uint32_t width = 0, height = 0, pointStep = 0, rowStep = 0; // points, [bytes]
    bool bigEndian = false;
    std::vector<PcdField> fields; // of unknown types: size 0
    std::span<const uint8_t> data;
    std::shared_ptr<const void> memory; // as MessageCursor::memory()
    std::string stepFault;              // what was stated of rows that have no gaps; empty = nothing wrong

    // Those that lie inside of a point.
    std::vector<PcdField> insideFields() const;
    // "640x480 points of x y z rgb, frame 'camera'".
    std::string words() const;
};

// Throws Error when the message is truncated or has more than 64 fields.
Cloud cloud(MessageCursor message);

// Why it is not played, with what is allowed; empty = it can be: 2 to 3840 columns, 2 to 2160 rows, x, y and
// z as float32 or float64 that lie inside of the points, all points inside of the data.
std::string whyNoDepth(const Cloud& cloud);
// Whether x, y and z have the byte order that is_bigendian states; one cloud may not decide it. Only where
// whyNoDepth() is empty.
ByteOrder pointsOrder(const Cloud& cloud);
// The points in row-major order, with colour from the fields that ColourFields finds. largest: as for
// ColourFields::read(). Only where whyNoDepth() is empty.
PcdCloud pointsOf(const Cloud& cloud, double& largest);

} // namespace fathom::ros
