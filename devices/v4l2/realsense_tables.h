// SPDX-License-Identifier: Apache-2.0
// Parsers for the calibration tables of a RealSense D4xx. Source of the layouts: librealsense
// (Apache-2.0), src/ds/d400/d400-private.{h,cpp}.
#pragma once

#include "devices/v4l2/video_node.h"
#include "engine/types/camera_info.h"

#include <cstdint>
#include <span>

namespace fathom::realsense {

// Table numbers.
constexpr uint32_t kDepthTable = 25;
constexpr uint32_t kColourTable = 32;

// All throw Error for a wrong length, table number or checksum.

// Lens of the rectified depth image of that size, without distortion. table: 576 bytes, header included.
Intrinsics depthLens(std::span<const uint8_t> table, VideoSize size);

// Content of the colour table for one image size.
struct ColourTable {
    Intrinsics lens;
    Pose colourTdepth; // maps points of the depth camera to the colour camera
};
// Source of colour, which determines how its sizes are cropped from the sensor.
enum class ColourSensor { Own, D405 };
constexpr uint16_t kD405 = 0x0b5b; // USB product number
ColourTable colourLens(std::span<const uint8_t> table, VideoSize size,
                       ColourSensor sensor = ColourSensor::Own);

// CRC-32 of zlib, as in the tables' headers.
uint32_t crc32(std::span<const uint8_t> bytes);

} // namespace fathom::realsense
