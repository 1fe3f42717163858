// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/ros_messages.h"

#include "devices/recorded/lens_model.h"
#include "engine/types/rotation_fault.h"

#include <array>
#include <cmath>
#include <optional>

namespace fathom::ros {

namespace {

constexpr uint32_t kMaxCoefficients = 64, kMaxLinks = 10'000;

struct Header {
    double stamp = 0.0;
    std::string frame;
};

std::string frameName(MessageCursor& cursor) {
    std::string name = cursor.name();
    return name.starts_with('/') ? name.substr(1) : name;
}

Header header(MessageCursor& cursor) {
    if (!cursor.cdr()) {
        cursor.word(); // sequence number
    }
    const uint32_t seconds = cursor.word(), nanos = cursor.word();
    return {seconds + 1e-9 * nanos, frameName(cursor)};
}

template <size_t N>
std::array<double, N> reals(MessageCursor& cursor) {
    std::array<double, N> out{};
    for (double& value : out) {
        value = cursor.real();
    }
    return out;
}

// Empty where the numbers are no pose.
std::optional<Pose> poseIn(MessageCursor& cursor) {
    const auto [x, y, z] = reals<3>(cursor);
    const auto [qx, qy, qz, qw] = reals<4>(cursor);
    const dquat q(qw, qx, qy, qz);
    const double length = glm::length(q);
    if (!(length > 1e-6) || !std::isfinite(length + x + y + z)) {
        return std::nullopt;
    }
    return Pose{{x, y, z}, q / length};
}

// Region of interest and binning of the image against the calibrated size.
struct Crop {
    uint32_t binX = 1, binY = 1, left = 0, top = 0, width = 0, height = 0;
};

Crop cropOf(MessageCursor& cursor, uint32_t width, uint32_t height) {
    Crop crop;
    crop.binX = std::max(1u, cursor.word());
    crop.binY = std::max(1u, cursor.word());
    crop.left = cursor.word();
    crop.top = cursor.word();
    crop.height = cursor.word();
    crop.width = cursor.word();
    if (crop.width == 0 || crop.height == 0) { // all of the image
        return {crop.binX, crop.binY, 0, 0, width, height};
    }
    if (crop.left > width || crop.width > width - crop.left || crop.top > height ||
        crop.height > height - crop.top) {
        throw Error("camera_info with a region of interest outside of its image");
    }
    return crop;
}

Intrinsics cropped(double fx, double fy, double cx, double cy, const Crop& crop) {
    Intrinsics lens;
    lens.width = crop.width / crop.binX;
    lens.height = crop.height / crop.binY;
    lens.fx = fx / crop.binX;
    lens.fy = fy / crop.binY;
    lens.cx = (cx - crop.left) / crop.binX;
    lens.cy = (cy - crop.top) / crop.binY;
    return lens;
}

std::vector<double> coefficients(MessageCursor& cursor) {
    const uint32_t count = cursor.word();
    if (count > kMaxCoefficients) {
        throw Error("camera_info with " + std::to_string(count) + " distortion coefficients");
    }
    std::vector<double> out(count);
    for (double& value : out) {
        value = cursor.real();
    }
    return out;
}

bool projects(double fx, double fy, double cx, double cy) {
    return fx > 0.0 && fy > 0.0 && std::isfinite(fx + fy + cx + cy);
}

// The lens of the raw image from K, that of the rectified image from P, or from K where P is not set.
void setLenses(CameraInfo& info, const std::array<double, 9>& k, const std::array<double, 12>& p,
               const Crop& crop) {
    const bool byK = projects(k[0], k[4], k[2], k[5]), byP = projects(p[0], p[5], p[2], p[6]);
    if (!byK) {
        info.rawFault = "camera_info without a focal length: the camera was not calibrated";
    } else {
        info.raw = cropped(k[0], k[4], k[2], k[5], crop);
    }
    if (!byK && !byP) {
        throw Error(info.rawFault);
    }
    info.rawSkew = k[1];
    info.rectifiedSkew = byP ? p[1] : k[1];
    info.rectified = byP ? cropped(p[0], p[5], p[2], p[6], crop) : info.raw;
    if (byP && std::isfinite(p[3] + p[7])) {
        info.shift = {p[3] / p[0], p[7] / p[5], 0.0};
    }
}

} // namespace

Image image(MessageCursor cursor) {
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
    out.memory = cursor.memory();
    out.compressed = out.encoding == "mjpg" || out.encoding == "mjpeg" || out.encoding == "MJPEG";
    return out;
}

std::string statedRows(uint64_t stated, uint64_t row) {
    return "rows of " + std::to_string(stated) + " bytes are stated where they have " + std::to_string(row);
}

Image compressedImage(MessageCursor cursor) {
    const Header head = header(cursor);
    Image out;
    out.compressed = true;
    out.stamp = head.stamp;
    out.frame = head.frame;
    out.format = cursor.name();
    out.encoding = out.format.substr(0, out.format.find(';'));
    out.data = cursor.block();
    out.memory = cursor.memory();
    return out;
}

double stamp(MessageCursor cursor) {
    return header(cursor).stamp;
}

CameraInfo cameraInfo(MessageCursor cursor) {
    CameraInfo info;
    info.frame = header(cursor).frame;
    const uint32_t height = cursor.word(), width = cursor.word();
    const std::string model = cursor.name();
    const std::vector<double> distortion = coefficients(cursor);
    const auto k = reals<9>(cursor), r = reals<9>(cursor);
    const auto p = reals<12>(cursor);
    setLenses(info, k, p, cropOf(cursor, width, height));
    const double diagonal = r[0] + r[4] + r[8];
    info.turned = diagonal != 0.0 && !(std::abs(diagonal - 3.0) < 1e-9);
    const std::string allowed = setDistortion(info.raw, model, distortion);
    if (!allowed.empty()) {
        info.raw = {};
        info.rawFault = "distortion model '" + model + "' with " + std::to_string(distortion.size()) +
                        " coefficients is not read: " + allowed;
    }
    return info;
}

void skipHeader(MessageCursor& cursor) {
    header(cursor);
}

Pose poseFromColumns(const std::array<double, 9>& r, const dvec3& translation) {
    const glm::dmat3 rotation(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]);
    if (!rotationFault(rotation, 0.01).empty() || !std::isfinite(glm::dot(translation, translation))) {
        throw Error("an invalid transform");
    }
    return {translation, glm::normalize(glm::quat_cast(rotation))};
}

Pose transform(MessageCursor cursor) {
    const auto pose = poseIn(cursor);
    if (!pose) {
        throw Error("an invalid transform");
    }
    return *pose;
}

Pose extrinsics(MessageCursor cursor, ExtrinsicsOf driver) {
    constexpr size_t kBare = 12 * sizeof(double); // some versions have no header
    if (cursor.left() != kBare) {
        header(cursor);
    }
    const auto rotation = reals<9>(cursor);
    const auto [x, y, z] = reals<3>(cursor);
    Pose pose = poseFromColumns(rotation, {x, y, z});
    if (driver == ExtrinsicsOf::Orbbec) {
        constexpr double kMaxApart = 1.0; // [m] of two lenses in one housing
        pose.rotation = glm::conjugate(pose.rotation);
        pose.position *= glm::length(pose.position) > kMaxApart ? 1e-3 : 1.0;
    }
    return pose;
}

float float32(MessageCursor cursor) {
    return cursor.value<float>();
}

std::vector<FrameLink> frameLinks(MessageCursor cursor) {
    const uint32_t count = cursor.word();
    if (count > kMaxLinks) {
        throw Error(std::to_string(count) + " transforms in one message");
    }
    std::vector<FrameLink> links;
    for (uint32_t i = 0; i < count; ++i) {
        FrameLink link;
        const Header head = header(cursor);
        link.parent = head.frame;
        link.stamp = head.stamp;
        link.child = frameName(cursor);
        const auto pose = poseIn(cursor);
        link.isValid = pose.has_value();
        link.parentTchild = pose.value_or(Pose{});
        links.push_back(std::move(link));
    }
    return links;
}

} // namespace fathom::ros
