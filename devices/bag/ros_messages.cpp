// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/ros_messages.h"

#include "devices/bag/byte_cursor.h"
#include "devices/v4l2/pixel_format.h"

#include <array>
#include <cmath>

namespace fathom::ros {

namespace {

struct Header {
    double stamp = 0.0;
    std::string frame;
};

Header header(ByteCursor& cursor) {
    cursor.word(); // sequence number
    const uint32_t seconds = cursor.word(), nanos = cursor.word();
    return {seconds + 1e-9 * nanos, cursor.name()};
}

struct Layout {
    const char* encoding;
    uint32_t bytes;            // per pixel
    std::array<int8_t, 3> rgb; // channel offsets
};
constexpr std::array kPlain{Layout{"rgb8", 3, {0, 1, 2}}, Layout{"bgr8", 3, {2, 1, 0}},
                            Layout{"rgba8", 4, {0, 1, 2}}, Layout{"bgra8", 4, {2, 1, 0}},
                            Layout{"mono8", 1, {0, 0, 0}}};
constexpr const char* kYuyv = "yuv422_yuy2";

std::string checkBytes(const Image& image, size_t row) {
    if (image.step < row || image.data.size() < size_t{image.step} * (image.height - 1) + row) {
        return "an image of " + std::to_string(image.data.size()) + " bytes in rows of " +
               std::to_string(image.step);
    }
    return image.bigEndian && image.encoding.find("16") != std::string::npos ? "big-endian pixels" : "";
}

} // namespace

Image image(std::span<const uint8_t> message) {
    ByteCursor cursor(message);
    const Header head = header(cursor);
    Image out;
    out.stamp = head.stamp;
    out.frame = head.frame;
    out.height = cursor.word();
    out.width = cursor.word();
    out.encoding = cursor.name();
    out.bigEndian = cursor.value<uint8_t>() != 0;
    out.step = cursor.word();
    out.data = cursor.block();
    return out;
}

Intrinsics cameraInfo(std::span<const uint8_t> message) {
    ByteCursor cursor(message);
    header(cursor);
    Intrinsics lens;
    lens.height = cursor.word();
    lens.width = cursor.word();
    const std::string model = cursor.name();
    const uint32_t count = cursor.word();
    bool straight = true;
    for (uint32_t i = 0; i < count; ++i) {
        const double k = cursor.real();
        straight = straight && k == 0.0;
        if (i < lens.distortion.size()) {
            lens.distortion[i] = k;
        }
    }
    // RealSense writes "Brown Conrady" for its rectified depth and zeros with every other name.
    if (!straight && (count > 5 || (model != "plumb_bob" && model != "Brown Conrady"))) {
        throw Error("distortion model '" + model + "' is not known");
    }
    std::array<double, 9> k{};
    for (double& value : k) {
        value = cursor.real();
    }
    lens.fx = k[0];
    lens.cx = k[2];
    lens.fy = k[4];
    lens.cy = k[5];
    if (!(lens.fx > 0.0) || !(lens.fy > 0.0) || !std::isfinite(lens.fx + lens.fy + lens.cx + lens.cy)) {
        throw Error("camera_info without a focal length: the camera was not calibrated");
    }
    return lens;
}

Pose transform(std::span<const uint8_t> message) {
    ByteCursor cursor(message);
    const double x = cursor.real(), y = cursor.real(), z = cursor.real();
    const double qx = cursor.real(), qy = cursor.real(), qz = cursor.real(), qw = cursor.real();
    const dquat q(qw, qx, qy, qz);
    const double length = glm::length(q);
    if (!(length > 1e-6) || !std::isfinite(length + x + y + z)) {
        throw Error("an invalid transform");
    }
    return {{x, y, z}, q / length};
}

float float32(std::span<const uint8_t> message) {
    return ByteCursor(message).value<float>();
}

bool isDepth(const std::string& encoding) {
    return encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1";
}

bool isColour(const std::string& encoding) {
    for (const Layout& layout : kPlain) {
        if (encoding == layout.encoding) {
            return true;
        }
    }
    return encoding == kYuyv;
}

std::string depthRows(const Image& image, std::span<uint16_t> out) {
    const bool metres = image.encoding == "32FC1";
    const std::string fault = checkBytes(image, size_t{image.width} * (metres ? 4 : 2));
    if (!fault.empty()) {
        return fault;
    }
    for (uint32_t y = 0; y < image.height; ++y) {
        const uint8_t* in = image.data.data() + size_t{y} * image.step;
        uint16_t* to = out.data() + size_t{y} * image.width;
        if (!metres) {
            std::memcpy(to, in, size_t{2} * image.width);
            continue;
        }
        for (uint32_t x = 0; x < image.width; ++x) {
            float z = 0.0f;
            std::memcpy(&z, in + 4 * x, 4);
            to[x] = z > 0.0f && z < 65.535f ? static_cast<uint16_t>(std::lround(1e3f * z)) : uint16_t{0};
        }
    }
    return "";
}

std::string colourRows(const Image& image, std::span<uint32_t> out) {
    if (image.encoding == kYuyv) {
        return unpackColour(fourccOf("YUYV"), {image.width, image.height}, image.step,
                            std::as_bytes(image.data), out);
    }
    for (const Layout& layout : kPlain) {
        if (image.encoding != layout.encoding) {
            continue;
        }
        const std::string fault = checkBytes(image, size_t{image.width} * layout.bytes);
        for (uint32_t y = 0; fault.empty() && y < image.height; ++y) {
            const uint8_t* in = image.data.data() + size_t{y} * image.step;
            for (uint32_t x = 0; x < image.width; ++x, in += layout.bytes) {
                out[size_t{y} * image.width + x] = uint32_t{in[layout.rgb[0]]} |
                                                   uint32_t{in[layout.rgb[1]]} << 8 |
                                                   uint32_t{in[layout.rgb[2]]} << 16 | 0xff000000u;
            }
        }
        return fault;
    }
    return "encoding " + image.encoding;
}

} // namespace fathom::ros
