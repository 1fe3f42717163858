// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/cloud_message.h"

#include "devices/bag/ros_messages.h"
#include "devices/pcd/colour_fields.h"
#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <string_view>

namespace fathom::ros {

namespace {

constexpr uint32_t kMaxFields = 64;

// By the constants INT8 to FLOAT64 of sensor_msgs/PointField, from 1 on.
void takeType(PcdField& field, uint8_t type) {
    constexpr std::string_view kTypes = "IUIUIUFF", kSizes = "11224448";
    const bool known = type >= 1 && type <= kTypes.size();
    field.type = known ? kTypes[type - 1] : '?';
    field.size = known ? kSizes[type - 1] - size_t{'0'} : 0;
}

// Drivers state the bytes of the whole cloud, the points of a row, or nothing.
void mendRows(Cloud& cloud) {
    const uint64_t row = uint64_t{cloud.pointStep} * cloud.width;
    const bool whole = row > 0 && row <= UINT32_MAX && cloud.data.size() == row * cloud.height;
    if (whole && cloud.rowStep != row) {
        cloud.stepFault = statedRows(cloud.rowStep, row);
        cloud.rowStep = static_cast<uint32_t>(row);
    }
}

} // namespace

std::vector<PcdField> Cloud::insideFields() const {
    std::vector<PcdField> inside = fields;
    std::erase_if(inside, [&](const PcdField& f) {
        return f.offset + std::max<size_t>(1, f.count) * f.size > pointStep;
    });
    return inside;
}

std::string Cloud::words() const {
    std::string text = sizeText(width, height) + " points of";
    for (const PcdField& field : fields) {
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
        PcdField field;
        field.name = cursor.name();
        field.offset = cursor.word();
        takeType(field, cursor.value<uint8_t>());
        field.count = cursor.word();
        out.fields.push_back(std::move(field));
    }
    out.bigEndian = cursor.value<uint8_t>() != 0;
    out.pointStep = cursor.word();
    out.rowStep = cursor.word();
    out.data = cursor.block();
    out.memory = cursor.memory();
    mendRows(out);
    return out;
}

std::string whyNoDepth(const Cloud& cloud) {
    if (cloud.height < 2 || cloud.width < 2) {
        return "a cloud that is not organised: " + sizeText(cloud.width, cloud.height) +
               " points (allowed: rows and columns of a depth image; record its depth images, or the cloud "
               "before it is filtered)";
    }
    if (cloud.width > kMaxImageWidth || cloud.height > kMaxImageHeight) {
        return "a cloud of " + sizeText(cloud.width, cloud.height) + " points (allowed: at most 3840x2160)";
    }
    for (const char* name : {"x", "y", "z"}) {
        const PcdField* field = fieldNamed(cloud.fields, name);
        const bool real = field != nullptr && field->type == 'F';
        if (!real || field->offset + field->size > cloud.pointStep) {
            return std::string("field ") + name +
                   (field == nullptr ? ": missing"
                    : real           ? ": beyond the bytes of a point"
                                     : ": not floating point") +
                   " (allowed: x, y and z of type float32 or float64)";
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

ByteOrder pointsOrder(const Cloud& cloud) {
    OrderOfReals order;
    for (const char* name : {"x", "y", "z"}) {
        const PcdField* field = fieldNamed(cloud.fields, name);
        for (uint32_t v = 0; v < cloud.height; ++v) {
            const uint8_t* point = cloud.data.data() + size_t{v} * cloud.rowStep;
            for (uint32_t u = 0; u < cloud.width; ++u, point += cloud.pointStep) {
                order.add(field->at(point, 0, cloud.bigEndian), field->at(point, 0, !cloud.bigEndian));
            }
        }
    }
    return order.order();
}

PcdCloud pointsOf(const Cloud& cloud, double& largest) {
    PcdCloud out{cloud.width, cloud.height, {}, {}, {}, {}};
    const PcdField *x = fieldNamed(cloud.fields, "x"), *y = fieldNamed(cloud.fields, "y"),
                   *z = fieldNamed(cloud.fields, "z");
    out.points.reserve(size_t{cloud.width} * cloud.height);
    for (uint32_t v = 0; v < cloud.height; ++v) {
        const uint8_t* point = cloud.data.data() + size_t{v} * cloud.rowStep;
        for (uint32_t u = 0; u < cloud.width; ++u, point += cloud.pointStep) {
            const auto at = [&](const PcdField& field) { return field.at(point, 0, cloud.bigEndian); };
            out.points.push_back({at(*x), at(*y), at(*z)});
        }
    }
    const std::vector<PcdField> fields = cloud.insideFields();
    out.colour = ColourFields(fields).read(
        {cloud.data.data(), cloud.width, cloud.height, cloud.pointStep, cloud.rowStep, cloud.bigEndian},
        largest);
    out.uncoloured = out.colour.empty() ? whyUncoloured(cloud.fields) : "";
    return out;
}

} // namespace fathom::ros
