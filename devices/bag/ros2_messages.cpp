// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/ros2_messages.h"

#include "devices/bag/byte_writer.h"
#include "devices/recorded/lens_model.h"

#include <array>

namespace fathom::ros2 {

namespace {

constexpr uint64_t kSecond = 1'000'000'000; // [ns]

void put(CdrWriter& out, const Header& header) {
    out.value(static_cast<int32_t>(header.time / kSecond));
    out.value(static_cast<uint32_t>(header.time % kSecond));
    out.text(header.frame);
}

CdrWriter begun(const Header& header) {
    CdrWriter out;
    put(out, header);
    return out;
}

void put(CdrWriter& out, const dvec3& v) {
    for (const double value : {v.x, v.y, v.z}) {
        out.value(value);
    }
}

void put(CdrWriter& out, const Pose& pose) {
    put(out, pose.position);
    const dquat& q = pose.rotation;
    for (const double value : {q.x, q.y, q.z, q.w}) {
        out.value(value);
    }
}

void putCount(CdrWriter& out, size_t count) {
    out.value(static_cast<uint32_t>(count));
}

void put(CdrWriter& out, Names names) {
    putCount(out, names.size());
    for (const std::string& name : names) {
        out.text(name);
    }
}

void put(CdrWriter& out, std::span<const double> numbers) {
    putCount(out, numbers.size());
    out.values(numbers);
}

void put(CdrWriter& out, const Header& header, const Marker& marker) {
    constexpr int kTexts = 3; // text, mesh, file of the mesh
    put(out, header);
    out.text(marker.space);
    out.value(marker.id);
    out.value(static_cast<int32_t>(marker.kind));
    out.value(static_cast<int32_t>(marker.action));
    put(out, marker.pose);
    put(out, marker.scale);
    out.values(std::span<const float>(marker.colour));
    out.value(int32_t{0}); // shown for ever
    out.value(uint32_t{0});
    out.value(uint8_t{0}); // not locked to its frame
    putCount(out, marker.points.size());
    for (const dvec3& point : marker.points) {
        put(out, point);
    }
    putCount(out, 0); // colours of points
    out.text("");     // texture
    put(out, Header{});
    out.text("");
    putCount(out, 0);
    putCount(out, 0);
    for (int i = 0; i < kTexts; ++i) {
        out.text("");
    }
    putCount(out, 0);
    out.value(uint8_t{0});
}

} // namespace

Message image(const Header& header, const ImageData& data) {
    CdrWriter out = begun(header);
    out.value(data.height);
    out.value(data.width);
    out.text(data.encoding);
    out.value(uint8_t{0}); // little-endian
    out.value(data.width * data.bytesPerPixel);
    out.block(data.bytes);
    return out.bytes();
}

Message cameraInfo(const Header& header, const Intrinsics& lens) {
    CdrWriter out = begun(header);
    out.value(lens.height);
    out.value(lens.width);
    out.text(distortionModel(lens));
    const std::vector<double> d = distortionCoefficients(lens);
    out.value(static_cast<uint32_t>(d.size()));
    out.values(std::span<const double>(d));
    const std::array<double, 9> k{lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1},
        r{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<double, 12> p{lens.fx, 0, lens.cx, 0, 0, lens.fy, lens.cy, 0, 0, 0, 1, 0};
    out.values(std::span<const double>(k));
    out.values(std::span<const double>(r));
    out.values(std::span<const double>(p));
    for (int i = 0; i < 6; ++i) { // no binning, no region of interest
        out.value(uint32_t{0});
    }
    out.value(uint8_t{0});
    return out.bytes();
}

Message transform(const Header& header, const ros::FrameLink& link) {
    CdrWriter out;
    out.value(uint32_t{1});
    put(out, {header.time, link.parent});
    out.text(link.child);
    put(out, link.parentTchild);
    return out.bytes();
}

Message transform(const Pose& pose) {
    CdrWriter out;
    put(out, pose);
    return out.bytes();
}

Message extrinsics(const Pose& pose) {
    CdrWriter out;
    const glm::dmat3 rotation = glm::mat3_cast(pose.rotation);
    for (int column = 0; column < 3; ++column) {
        put(out, rotation[column]);
    }
    put(out, pose.position);
    return out.bytes();
}

Message float32(float number) {
    CdrWriter out;
    out.value(number);
    return out.bytes();
}

Message pose(const Header& header, const Pose& pose) {
    CdrWriter out = begun(header);
    put(out, pose);
    return out.bytes();
}

Message wrench(const Header& header, const dvec3& force, const dvec3& torque) {
    CdrWriter out = begun(header);
    put(out, force);
    put(out, torque);
    return out.bytes();
}

Message regions(const Header& header, std::span<const RegionPoint> points) {
    constexpr std::array kFields{"x", "y", "z", "radius", "class"};
    constexpr uint8_t kFloat32 = 7;
    CdrWriter out = begun(header);
    const auto count = static_cast<uint32_t>(points.size());
    out.value(uint32_t{1});
    out.value(count);
    out.value(static_cast<uint32_t>(kFields.size()));
    for (uint32_t i = 0; i < kFields.size(); ++i) {
        out.text(kFields[i]);
        out.value(4 * i);
        out.value(kFloat32);
        out.value(uint32_t{1});
    }
    out.value(uint8_t{0}); // little-endian
    out.value(static_cast<uint32_t>(sizeof(RegionPoint)));
    out.value(static_cast<uint32_t>(sizeof(RegionPoint)) * count);
    out.block({reinterpret_cast<const uint8_t*>(points.data()), points.size_bytes()});
    out.value(uint8_t{1}); // no point is missing
    return out.bytes();
}

Message twist(const Header& header, const dvec3& linear, const dvec3& angular) {
    CdrWriter out = begun(header);
    put(out, linear);
    put(out, angular);
    return out.bytes();
}

Message jointState(const Header& header, Names names, std::span<const double> positions) {
    CdrWriter out = begun(header);
    put(out, names);
    put(out, positions);
    putCount(out, 0); // velocities
    putCount(out, 0); // efforts
    return out.bytes();
}

Message trajectory(const Header& header, Names names, std::span<const double> positions, double seconds) {
    CdrWriter out = begun(header);
    put(out, names);
    putCount(out, 1);
    put(out, positions);
    putCount(out, 0); // velocities
    putCount(out, 0); // accelerations
    putCount(out, 0); // efforts
    const auto time = static_cast<uint64_t>(seconds * static_cast<double>(kSecond));
    out.value(static_cast<int32_t>(time / kSecond));
    out.value(static_cast<uint32_t>(time % kSecond));
    return out.bytes();
}

Message diagnostics(const Header& header, std::span<const Diagnosis> parts) {
    CdrWriter out = begun(header);
    putCount(out, parts.size());
    for (const Diagnosis& part : parts) {
        out.value(static_cast<uint8_t>(part.level));
        out.text(part.name);
        out.text(part.message);
        out.text(""); // no hardware
        putCount(out, part.values.size());
        for (const auto& [key, value] : part.values) {
            out.text(key);
            out.text(value);
        }
    }
    return out.bytes();
}

Message markers(const Header& header, std::span<const Marker> markers) {
    CdrWriter out;
    putCount(out, markers.size());
    for (const Marker& marker : markers) {
        put(out, header, marker);
    }
    return out.bytes();
}

} // namespace fathom::ros2
