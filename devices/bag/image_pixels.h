// SPDX-License-Identifier: Apache-2.0
// Converts the images of messages to those of a Frame. Sources: sensor_msgs/image_encodings and the packages
// compressed_image_transport and compressed_depth_image_transport.
#pragma once

#include "devices/bag/ros_messages.h"
#include "devices/images/byte_order.h"
#include "devices/images/metre_units.h"
#include "engine/types/colour_format.h"

#include <optional>

namespace fathom::ros {

// What an image may be used as, by its encoding alone.
enum class Content { None, Depth, Colour, Grey };
Content content(const Image& image);
// Encodings that are read, for messages.
inline constexpr const char* kDepthEncodings =
    "16UC1, mono16, 32FC1, or these as compressedDepth or PNG, z16, rvl";
inline constexpr const char* kColourEncodings =
    "rgb8, bgr8, rgba8, bgra8, the same with 16 bits, 8UC3, 8UC4, yuv422, uyvy, yuyv, yuy2, nv12, nv21, "
    "i420, yv12, bayer_*, JPEG (mjpg), PNG";

// Width and height [pixels]; of a compressed image as its header states them, empty when it has no readable
// header.
std::optional<std::pair<uint32_t, uint32_t>> sizeOf(const Image& image);

// Where the stated step of rows cannot be that of the image, and the bytes are those of rows without gaps:
// sets it. Returns what was stated, empty = nothing was set.
std::string correctStep(Image& image);

// Whether the bytes of uncompressed depth have the order that is_bigendian states; by one image, whose values
// may not decide it.
ByteOrder depthOrder(const Image& image);

// Whether depth values are metres (float) rather than the sensor's units.
bool holdsMetres(const Image& image);

// Depth to raw units, 0 = no measurement. Metres are divided by metresPerUnit and rounded; `beyond` counts
// those too far for 16 bits, which become 0. Returns the fault, or empty when everything was converted. The
// image's size must be that of `out`.
std::string depthRows(const Image& image, double metresPerUnit, std::span<uint16_t> out, uint64_t& beyond);
// How colourRows() leaves this image.
ColourFormat colourFormat(const Image& image);
// R8 G8 B8 A8 (0xAABBGGRR) if that is the image's colourFormat(). Else `raw` describes the bytes in `out`
// that the device unpacks. out: room for mostColourBytes(). Returns as depthRows().
std::string colourRows(const Image& image, std::span<uint32_t> out, RawColour& raw);
// Depth [m] of an image that holds metres; without any when it cannot be read.
ValueSpan valueSpan(const Image& image);

} // namespace fathom::ros
