// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/orbbec_profile.h"

#include "devices/bag/ros_messages.h"
#include "devices/recorded/lens_model.h"

#include <array>

namespace fathom {

namespace {

// OBCameraDistortionModel by number, with the coefficients that the SDK uses.
struct OrbbecLens {
    const char* model;
    size_t coefficients;
};
constexpr std::array kOrbbecLenses{OrbbecLens{"none", 0},
                                   OrbbecLens{"modified_brown_conrady", 5},
                                   OrbbecLens{"inverse_brown_conrady", 5},
                                   OrbbecLens{"brown_conrady", 5},
                                   OrbbecLens{"rational_polynomial", 8},
                                   OrbbecLens{"kannala_brandt4", 4}};

template <size_t N>
std::array<double, N> floats(MessageCursor& cursor) {
    std::array<double, N> out{};
    for (double& value : out) {
        value = double{cursor.value<float>()};
    }
    return out;
}

// k: k1 to k6, p1, p2.
void setOrbbecDistortion(Intrinsics& lens, uint8_t model, const std::array<double, 8>& k) {
    if (model >= kOrbbecLenses.size()) {
        throw Error("distortion model " + std::to_string(model) + " is not read (allowed: 0 to 5)");
    }
    const auto& [name, count] = kOrbbecLenses[model];
    const std::array<double, 8> brown{k[0], k[1], k[6], k[7], k[2], k[3], k[4], k[5]};
    const std::string allowed = setDistortion(lens, name, std::span(count == 4 ? k : brown).first(count));
    if (!allowed.empty()) {
        throw Error(std::string("distortion model ") + name + " (allowed: " + allowed + ")");
    }
}

} // namespace

OrbbecProfile orbbecProfile(MessageCursor cursor) {
    constexpr double kMetresPerMillimetre = 1e-3;
    ros::skipHeader(cursor);
    cursor.value<uint16_t>();         // stream and format, also in the names of topics and in the images
    const auto r = floats<9>(cursor); // row by row
    const auto t = floats<3>(cursor);
    OrbbecProfile out;
    out.lens.width = cursor.value<uint16_t>();
    out.lens.height = cursor.value<uint16_t>();
    cursor.value<uint16_t>(); // frames per second
    const auto [fx, fy, cx, cy] = floats<4>(cursor);
    out.lens.fx = fx;
    out.lens.fy = fy;
    out.lens.cx = cx;
    out.lens.cy = cy;
    const auto distortion = floats<8>(cursor);
    setOrbbecDistortion(out.lens, cursor.value<uint8_t>(), distortion);
    if (r != std::array<double, 9>{}) {
        out.colourTdepth = ros::poseFromColumns({r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]},
                                                kMetresPerMillimetre * dvec3(t[0], t[1], t[2]));
    }
    return out;
}

} // namespace fathom
