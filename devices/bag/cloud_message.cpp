// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/cloud_message.h"

#include "devices/recorded/recording_intrinsics.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace fathom::ros {

namespace {

constexpr uint32_t kMaxFields = 64;
constexpr uint8_t kFloat32 = 7;

bool fourBytes(const Cloud::Field& field) {
    return field.type >= 5 && field.type <= 7; // int32, uint32, float32
}

const Cloud::Field* colourField(const Cloud& cloud) {
    const Cloud::Field* field = cloud.find("rgb");
    field = field != nullptr ? field : cloud.find("rgba");
    return field != nullptr && fourBytes(*field) && field->offset + uint64_t{4} <= cloud.pointStep ? field
                                                                                                   : nullptr;
}

double coordinate(const uint8_t* point, uint32_t offset, bool bigEndian) {
    uint32_t bits = 0;
    std::memcpy(&bits, point + offset, sizeof bits);
    return double{std::bit_cast<float>(bigEndian ? __builtin_bswap32(bits) : bits)};
}

} // namespace

const Cloud::Field* Cloud::find(const std::string& name) const {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

std::string Cloud::words() const {
    std::string text = std::to_string(width) + "x" + std::to_string(height) + " points of";
    for (const Field& field : fields) {
        text += ' ';
        text += field.name.substr(0, 40);
    }
    return text + ", frame '" + frame + "'";
}

Cloud cloud(MessageCursor cursor) {
    Cloud out;
    cursor.word(); // a sequence number in ROS 1, the stamp's seconds in ROS 2
    cursor.word();
    if (!cursor.cdr()) {
        cursor.word();
    }
    out.frame = cursor.name();
    out.height = cursor.word();
    out.width = cursor.word();
    const uint32_t count = cursor.word();
    if (count > kMaxFields) {
        throw Error("a cloud with " + std::to_string(count) + " fields (allowed: at most 64)");
    }
    for (uint32_t i = 0; i < count; ++i) {
        Cloud::Field field;
        field.name = cursor.name();
        field.offset = cursor.word();
        field.type = cursor.value<uint8_t>();
        field.count = cursor.word();
        out.fields.push_back(std::move(field));
    }
    out.bigEndian = cursor.value<uint8_t>() != 0;
    out.pointStep = cursor.word();
    out.rowStep = cursor.word();
    out.data = cursor.block();
    out.memory = cursor.memory();
    return out;
}

std::string whyNoDepth(const Cloud& cloud) {
    if (cloud.height < 2 || cloud.width < 2) {
        return "a cloud that is not organised: " + std::to_string(cloud.width) + "x" +
               std::to_string(cloud.height) +
               " points (allowed: rows and columns of a depth image; record its depth images, or the cloud "
               "before it is filtered)";
    }
    if (cloud.width > kMaxImageWidth || cloud.height > kMaxImageHeight) {
        return "a cloud of " + std::to_string(cloud.width) + "x" + std::to_string(cloud.height) +
               " points (allowed: at most 3840x2160)";
    }
    for (const char* name : {"x", "y", "z"}) {
        const Cloud::Field* field = cloud.find(name);
        if (field == nullptr || field->type != kFloat32 || field->offset + uint64_t{4} > cloud.pointStep) {
            return std::string("field ") + name + (field == nullptr ? ": missing" : ": not float32") +
                   " (allowed: x, y and z of type float32)";
        }
    }
    const uint64_t row = uint64_t{cloud.pointStep} * cloud.width;
    if (cloud.rowStep < row || cloud.data.size() < uint64_t{cloud.rowStep} * (cloud.height - 1) + row) {
        return "a cloud of " + std::to_string(cloud.data.size()) + " bytes in rows of " +
               std::to_string(cloud.rowStep) + " (allowed: " + std::to_string(cloud.height) + " rows of " +
               std::to_string(row) + ")";
    }
    return "";
}

PcdCloud pointsOf(const Cloud& cloud) {
    PcdCloud out{cloud.width, cloud.height, {}, {}, {}};
    const uint32_t x = cloud.find("x")->offset, y = cloud.find("y")->offset, z = cloud.find("z")->offset;
    const Cloud::Field* colour = colourField(cloud);
    const size_t count = size_t{cloud.width} * cloud.height;
    out.points.reserve(count);
    out.colour.reserve(colour != nullptr ? count : 0);
    for (uint32_t v = 0; v < cloud.height; ++v) {
        const uint8_t* point = cloud.data.data() + size_t{v} * cloud.rowStep;
        for (uint32_t u = 0; u < cloud.width; ++u, point += cloud.pointStep) {
            out.points.push_back({coordinate(point, x, cloud.bigEndian),
                                  coordinate(point, y, cloud.bigEndian),
                                  coordinate(point, z, cloud.bigEndian)});
            if (colour != nullptr) {
                const uint8_t* c = point + colour->offset;
                const std::array<uint8_t, 3> rgb =
                    cloud.bigEndian ? std::array{c[1], c[2], c[3]} : std::array{c[2], c[1], c[0]};
                out.colour.push_back(0xff000000u | uint32_t{rgb[2]} << 16 | uint32_t{rgb[1]} << 8 |
                                     uint32_t{rgb[0]});
            }
        }
    }
    return out;
}

} // namespace fathom::ros
