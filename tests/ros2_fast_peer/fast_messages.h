// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2, read and written by Fast CDR from their definitions.
#pragma once

#include "tests/ros2_listener/said.h"

#include <array>
#include <cstdlib>
#include <fastcdr/Cdr.h>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using Bytes = std::vector<char>; // with the header of the encapsulation

inline Said headerOf(Cdr& cdr) {
    int32_t seconds = 0;
    uint32_t nanoseconds = 0;
    std::string frame;
    cdr >> seconds >> nanoseconds >> frame;
    return Said().stamp(seconds, nanoseconds).word(frame);
}

inline void printNumbers(Cdr& cdr, int count) {
    Said line = headerOf(cdr);
    for (int i = 0; i < count; ++i) {
        double number = 0.0;
        cdr >> number;
        line.number(number);
    }
    line.print();
}

// Fields, count of points, and the first point.
inline void printCloud(Cdr& cdr) {
    Said line = headerOf(cdr);
    uint32_t height = 0, width = 0, fields = 0, offset = 0, count = 0, pointStep = 0, rowStep = 0, size = 0;
    uint8_t type = 0, bigEndian = 0;
    std::string names, name;
    cdr >> height >> width >> fields;
    for (uint32_t i = 0; i < fields; ++i) {
        cdr >> name >> offset >> type >> count;
        names += (i == 0 ? "" : ",") + name;
    }
    cdr >> bigEndian >> pointStep >> rowStep >> size;
    line.word(names).number(width).number(height).number(pointStep).number(size);
    for (uint32_t i = 0; i < 5 && size >= 20; ++i) { // the first point happens to be aligned
        float value = 0.0f;
        cdr >> value;
        line.number(static_cast<double>(value));
    }
    line.print();
}

inline void printDiagnostics(Cdr& cdr) {
    const Said header = headerOf(cdr);
    uint32_t parts = 0;
    cdr >> parts;
    for (uint32_t i = 0; i < parts; ++i) {
        Said line = header;
        uint8_t level = 0;
        uint32_t values = 0;
        std::string name, message, hardware, key, value;
        cdr >> level >> name >> message >> hardware >> values;
        line.number(level).word(name).word(message);
        for (uint32_t k = 0; k < values; ++k) {
            cdr >> key >> value;
            line.word(key + "=" + value);
        }
        line.print();
    }
}

inline void putHeader(Cdr& cdr, const std::vector<double>& n) {
    static int32_t second = 17; // long ago: readers must not depend on it
    cdr << second++ << uint32_t{0} << std::string("handle_base");
    for (const double number : n) {
        cdr << number;
    }
}

// WIDTH HEIGHT MILLIMETRES: 16UC1.
inline void putImage(Cdr& cdr, const std::vector<double>& n) {
    const auto width = static_cast<uint32_t>(n.at(0)), height = static_cast<uint32_t>(n.at(1));
    putHeader(cdr, {});
    cdr << height << width << std::string("16UC1") << uint8_t{0} << 2 * width;
    std::vector<uint8_t> rows(2 * width * height);
    for (size_t i = 0; i < rows.size(); i += 2) {
        rows[i] = static_cast<uint8_t>(static_cast<int>(n.at(2)) & 0xff);
        rows[i + 1] = static_cast<uint8_t>(static_cast<int>(n.at(2)) >> 8);
    }
    cdr << rows;
}

// WIDTH HEIGHT FOCAL_LENGTH
inline void putInfo(Cdr& cdr, const std::vector<double>& n) {
    const double f = n.at(2), cx = 0.5 * n.at(0), cy = 0.5 * n.at(1);
    putHeader(cdr, {});
    cdr << static_cast<uint32_t>(n.at(1)) << static_cast<uint32_t>(n.at(0)) << std::string("plumb_bob");
    cdr << std::vector<double>(5, 0.0);
    cdr << std::array<double, 9>{f, 0, cx, 0, f, cy, 0, 0, 1}
        << std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1};
    cdr << std::array<double, 12>{f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0};
    for (int i = 0; i < 6; ++i) { // no binning, no region of interest
        cdr << uint32_t{0};
    }
    cdr << false;
}

// A request of std_srvs/srv/SetBool or Trigger behind the header of rmw_cyclonedds: the numbers of client and
// request. "rmw_fastrtps": without it.
inline Bytes requestOf(const std::string& line, uint64_t client, int64_t number) {
    FastBuffer buffer;
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    if (line != "rmw_fastrtps") {
        cdr << client << number;
    }
    cdr << static_cast<uint8_t>(line == "1" ? 1 : 0);
    return Bytes(buffer.getBuffer(), buffer.getBuffer() + cdr.getSerializedDataLength());
}

// Prints "NUMBER SUCCESS MESSAGE". False: it is another client's, or answers another request.
inline bool printReply(Bytes& bytes, uint64_t client, int64_t number) {
    FastBuffer buffer(bytes.data(), bytes.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    uint64_t to = 0;
    int64_t of = 0;
    uint8_t success = 0;
    std::string message;
    cdr >> to >> of >> success >> message;
    if (to != client || of != number) {
        return false;
    }
    Said().number(static_cast<double>(number)).number(success).word(message).print();
    return true;
}

struct Type {
    const char* name;
    void (*print)(Cdr& cdr);
    void (*put)(Cdr& cdr, const std::vector<double>& numbers) = putHeader;
};

inline const std::map<std::string, Type> kTypes{
    {"SetBool", {"std_srvs::srv::dds_::SetBool_", printCloud}},
    {"Trigger", {"std_srvs::srv::dds_::Trigger_", printCloud}},
    {"Image", {"sensor_msgs::msg::dds_::Image_", printCloud, putImage}},
    {"CameraInfo", {"sensor_msgs::msg::dds_::CameraInfo_", printCloud, putInfo}},
    {"PoseStamped", {"geometry_msgs::msg::dds_::PoseStamped_", [](Cdr& cdr) { printNumbers(cdr, 7); }}},
    {"WrenchStamped", {"geometry_msgs::msg::dds_::WrenchStamped_", [](Cdr& cdr) { printNumbers(cdr, 6); }}},
    {"TwistStamped", {"geometry_msgs::msg::dds_::TwistStamped_", [](Cdr& cdr) { printNumbers(cdr, 6); }}},
    {"PointCloud2", {"sensor_msgs::msg::dds_::PointCloud2_", printCloud}},
    {"DiagnosticArray", {"diagnostic_msgs::msg::dds_::DiagnosticArray_", printDiagnostics}}};

// A line of numbers as a message. "short": one that ends within its header; "big ...": big-endian.
inline Bytes messageOf(const Type& type, const std::string& line) {
    if (line == "short") {
        return {0, 1, 0, 0, 17, 0};
    }
    std::istringstream words(line);
    std::vector<double> numbers;
    bool big = false;
    for (std::string word; words >> word;) {
        if (word == "big") {
            big = true;
        } else {
            numbers.push_back(std::strtod(word.c_str(), nullptr));
        }
    }
    FastBuffer buffer; // grows
    Cdr cdr(buffer, big ? Cdr::BIG_ENDIANNESS : Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    type.put(cdr, numbers);
    return Bytes(buffer.getBuffer(), buffer.getBuffer() + cdr.getSerializedDataLength());
}
