// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/replay_output.h"

#include "engine/types/parse_number.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <png.h>
#include <stdexcept>

namespace fathom {

namespace {

constexpr const char* kTickHeader =
    "t_s,dev_x,dev_y,dev_z,dev_qw,dev_qx,dev_qy,dev_qz,tool_x,tool_y,tool_z,tool_qw,tool_qx,tool_qy,tool_qz,"
    "fx,fy,fz,tx,ty,tz,contacts,min_gap_m,state,guidance,frame,scene_age_s,stalled,margin_passive,margin_"
    "uncoupled,cause,lag_m,out_fx,out_fy,out_fz,out_tx,out_ty,out_tz,rest_fx,rest_fy,rest_fz,rest_tx,rest_ty,"
    "rest_tz,clearance_m";
constexpr const char* kFrameHeader =
    "index,t_s,valid,forbidden_points,spheres,patches,nodes,guidance_count,upload_ms";

[[noreturn]] void fail(const std::filesystem::path& file, size_t line, const std::string& why) {
    throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + why);
}

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields{""};
    for (char c : line) {
        if (c == ',') {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

std::vector<std::string> linesOf(const std::filesystem::path& file) {
    const std::string text = readWhole(file);
    std::vector<std::string> lines;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = text.find('\n', begin);
        if (end == std::string::npos) {
            fail(file, lines.size() + 1, "the last line does not end");
        }
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

// Reads the fields of one row from left to right.
class Fields {
public:
    Fields(const std::filesystem::path& file, size_t line, const std::string& text)
        : file_(file)
        , line_(line)
        , fields_(split(text)) {}
    size_t count() const { return fields_.size(); }
    const std::string& word() { return fields_.at(next_++); }
    double number() {
        const std::string& field = word();
        if (field == "nan") {
            return std::nan("");
        }
        return parse<double>(field);
    }
    uint64_t whole() { return parse<uint64_t>(word()); }
    int signedWhole() { return parse<int>(word()); }
    dvec3 vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }
    Pose pose() {
        Pose pose;
        pose.position = vector();
        const double w = number();
        const dvec3 v = vector();
        pose.rotation = dquat(w, v.x, v.y, v.z);
        return pose;
    }

private:
    template <class T>
    T parse(const std::string& field) {
        T value{};
        if (!parseWhole(field, value)) {
            fail(file_, line_, "'" + field + "' is no number");
        }
        return value;
    }
    const std::filesystem::path& file_;
    size_t line_;
    std::vector<std::string> fields_;
    size_t next_ = 0;
};

template <class T>
T fromBytes(const char*& next) {
    T value;
    std::memcpy(&value, next, sizeof value); // both the file and this machine are little-endian
    next += sizeof value;
    return value;
}

} // namespace

std::string readWhole(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        fail(file, 0, "there is no such file");
    }
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Tick> readTicks(const std::filesystem::path& file) {
    const std::vector<std::string> lines = linesOf(file);
    if (lines.empty() || lines[0] != kTickHeader) {
        fail(file, 1, "another header than the contract's");
    }
    std::vector<Tick> ticks;
    for (size_t i = 1; i < lines.size(); ++i) {
        Fields row(file, i + 1, lines[i]);
        if (row.count() != 45) {
            fail(file, i + 1, std::to_string(row.count()) + " fields");
        }
        Tick tick{};
        tick.t = row.number();
        tick.device = row.pose();
        tick.tool = row.pose();
        tick.force = row.vector();
        tick.torque = row.vector();
        tick.contacts = static_cast<uint32_t>(row.whole());
        tick.minGap = row.number();
        tick.state = row.word();
        tick.guidance = row.number();
        tick.frame = row.signedWhole();
        tick.sceneAge = row.number();
        tick.stalled = static_cast<uint32_t>(row.whole());
        tick.marginPassive = row.number();
        tick.marginUncoupled = row.number();
        tick.cause = static_cast<uint32_t>(row.whole());
        tick.lag = row.number();
        tick.outForce = row.vector();
        tick.outTorque = row.vector();
        tick.restForce = row.vector();
        tick.restTorque = row.vector();
        tick.clearance = row.number();
        ticks.push_back(tick);
    }
    return ticks;
}

std::vector<FrameRow> readFrames(const std::filesystem::path& file, std::vector<std::string>* timeColumns) {
    const std::vector<std::string> lines = linesOf(file);
    const std::string& header = lines.at(0);
    if (header.rfind(kFrameHeader, 0) != 0 || !header.ends_with(",publish_ms,answerable_ms")) {
        fail(file, 1, "another header than the contract's");
    }
    const std::vector<std::string> all = split(header);
    const std::vector<std::string> columns(all.begin() + 8, all.end());
    for (const std::string& column : columns) {
        if (!column.ends_with("_ms")) {
            fail(file, 1, "'" + column + "' is no time in ms");
        }
    }
    if (timeColumns != nullptr) {
        *timeColumns = columns;
    }
    std::vector<FrameRow> frames;
    for (size_t i = 1; i < lines.size(); ++i) {
        Fields row(file, i + 1, lines[i]);
        if (row.count() != all.size()) {
            fail(file, i + 1, std::to_string(row.count()) + " fields");
        }
        FrameRow frame{};
        frame.index = static_cast<uint32_t>(row.whole());
        frame.t = row.number();
        for (uint64_t* count : {&frame.valid, &frame.forbidden, &frame.spheres, &frame.patches, &frame.nodes,
                                &frame.guidance}) {
            *count = row.whole();
        }
        for (const std::string& column : columns) {
            frame.times[column] = row.number();
        }
        frames.push_back(frame);
    }
    return frames;
}

std::vector<SavedSphere> readPly(const std::filesystem::path& file) {
    const std::string text = readWhole(file);
    const std::string mark = "end_header\n", format = "ply\nformat binary_little_endian 1.0\n";
    const size_t end = text.find(mark);
    if (end == std::string::npos || text.rfind(format, 0) != 0) {
        fail(file, 1, "no binary little-endian PLY");
    }
    const std::string head = text.substr(0, end);
    const std::string properties =
        "property double x\nproperty double y\nproperty double z\nproperty double radius\n"
        "property int class\nproperty int held\n";
    const size_t element = head.find("element vertex ");
    if (element == std::string::npos || !head.ends_with(properties)) {
        fail(file, 1, "other properties than the contract's");
    }
    const size_t count = std::stoul(head.substr(element + 15));
    const char* next = text.data() + end + mark.size();
    if (text.size() - end - mark.size() != count * 40) {
        fail(file, 1, "its length is not that of " + std::to_string(count) + " vertices");
    }
    std::vector<SavedSphere> spheres;
    for (size_t i = 0; i < count; ++i) {
        SavedSphere sphere{};
        for (int axis = 0; axis < 3; ++axis) {
            sphere.centre[axis] = fromBytes<double>(next);
        }
        sphere.radius = fromBytes<double>(next);
        sphere.fixture = fromBytes<int32_t>(next);
        sphere.held = fromBytes<int32_t>(next);
        spheres.push_back(sphere);
    }
    return spheres;
}

ReadImage readImage(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&png, file.c_str()) == 0) {
        fail(file, 0, png.message);
    }
    png.format = PNG_FORMAT_RGBA;
    ReadImage image{png.width, png.height, std::vector<uint32_t>(size_t{png.width} * png.height)};
    if (png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) == 0) {
        fail(file, 0, png.message);
    }
    return image;
}

} // namespace fathom
