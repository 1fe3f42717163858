// SPDX-License-Identifier: Apache-2.0
// Parsers for the messages of a depth camera, as ROS 1 and ROS 2 serialise them. Source: the .msg definitions
// of sensor_msgs, geometry_msgs, tf2_msgs, std_msgs and realsense2_camera_msgs.
#pragma once

#include "devices/bag/message_cursor.h"
#include "engine/types/camera_info.h"
#include "engine/types/error.h"

#include <array>
#include <vector>

namespace fathom::ros {

// All throw Error when the message is truncated or invalid. Names of frames are without the slash that old
// packages write in front of them.

// sensor_msgs/Image or CompressedImage; a view into the message, whose memory it keeps.
struct Image {
    double stamp = 0.0; // [s]
    std::string frame, encoding;
    uint32_t width = 0, height = 0, step = 0; // [pixels], [bytes] per row; 0: compressed
    bool bigEndian = false;
    bool compressed = false;            // also of an Image whose encoding is mjpg, as the SDKs write it
    std::string format;                 // of a compressed image, e.g. "16UC1; compressedDepth png"
    std::span<const uint8_t> data;      // of the message's bytes
    std::shared_ptr<const void> memory; // as MessageCursor::memory()
};
Image image(MessageCursor message);
// "rows of 0 bytes are stated where they have 160": of images and clouds whose rows can be known.
std::string statedRows(uint64_t stated, uint64_t row);
Image compressedImage(MessageCursor message);
double stamp(MessageCursor message); // [s] of any message that begins with a header

// sensor_msgs/CameraInfo.
struct CameraInfo {
    std::string frame;
    Intrinsics raw;       // K and D, in pixels of the images: binning and region of interest are applied
    std::string rawFault; // why K or D cannot be used, `raw` is empty then; empty = nothing
    Intrinsics rectified; // P, without distortion; K where P is empty
    bool turned = false;  // rectification turns the camera (R)
    double rawSkew = 0.0, rectifiedSkew = 0.0; // [pixels] of K and P, which no lens here has
    // [m] What is added to points of the header's frame to be seen from the camera's centre: Tx / fx and Ty /
    // fy of P, which are not 0 for the second camera of a rectified stereo pair.
    dvec3 shift{0.0};
    // Of rectified images, or of others. Throws Error where that is not usable.
    const Intrinsics& lens(bool ofRectified) const {
        if (!ofRectified && !rawFault.empty()) {
            throw Error(rawFault);
        }
        return ofRectified ? rectified : raw;
    }
};
// sensor_msgs/CameraInfo. Throws Error for bytes that are none.
CameraInfo cameraInfo(MessageCursor message);

// Reads over a std_msgs/Header.
void skipHeader(MessageCursor& cursor);
// From a rotation matrix, column by column. Throws Error when it is none.
Pose poseFromColumns(const std::array<double, 9>& rotation, const dvec3& translation);

Pose transform(MessageCursor message); // geometry_msgs/Transform
// The driver whose message it is. realsense2_camera_msgs/Extrinsics has its rotation column by column, those
// of Orbbec row by row, and with millimetres in older versions.
enum class ExtrinsicsOf { RealSense, Orbbec };
Pose extrinsics(MessageCursor message, ExtrinsicsOf driver);
float float32(MessageCursor message); // std_msgs/Float32

// One transform of a tf2_msgs/TFMessage.
struct FrameLink {
    std::string parent, child;
    Pose parentTchild;
    double stamp = 0.0;  // [s]
    bool isValid = true; // false: its numbers are no pose, and parentTchild is the identity
};
std::vector<FrameLink> frameLinks(MessageCursor message);

} // namespace fathom::ros
