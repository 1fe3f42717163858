// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/ros2_messages.h"

#include "devices/bag/byte_writer.h"
#include "devices/recorded/lens_model.h"

#include <array>

namespace fathom::ros2 {

namespace {

CdrWriter begun(const Header& header) {
    constexpr uint64_t kSecond = 1'000'000'000;
    CdrWriter out;
    out.value(static_cast<int32_t>(header.time / kSecond));
    out.value(static_cast<uint32_t>(header.time % kSecond));
    out.text(header.frame);
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

} // namespace

Message image(const Header& header, const Picture& picture) {
    CdrWriter out = begun(header);
    out.value(picture.height);
    out.value(picture.width);
    out.text(picture.encoding);
    out.value(uint8_t{0}); // little-endian
    out.value(picture.width * picture.bytesPerPixel);
    out.block(picture.bytes);
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
    constexpr uint64_t kSecond = 1'000'000'000;
    out.value(static_cast<int32_t>(header.time / kSecond));
    out.value(static_cast<uint32_t>(header.time % kSecond));
    out.text(link.parent);
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

} // namespace fathom::ros2
