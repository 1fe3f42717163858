// SPDX-License-Identifier: Apache-2.0
// Lens models against the formulas of their makers, written out here independently.
#include "engine/types/camera_info.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr double kTolerance = 0.01; // [pixels]

Intrinsics lens(LensModel model, std::array<double, 5> distortion, std::array<double, 3> divisor = {}) {
    return {.width = 640,
            .height = 480,
            .fx = 610.0,
            .fy = 608.0,
            .cx = 321.5,
            .cy = 243.0,
            .distortion = distortion,
            .model = model,
            .divisor = divisor};
}

// OpenCV, calib3d: x'' = x' (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4 r2 + k5 r4 + k6 r6) + 2 p1 x'y' + p2 (r2 +
// 2 x'^2).
glm::dvec2 openCv(const Intrinsics& l, double x, double y) {
    const auto& d = l.distortion;
    const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
    const double radial = (1 + d[0] * r2 + d[1] * r4 + d[4] * r6) /
                          (1 + l.divisor[0] * r2 + l.divisor[1] * r4 + l.divisor[2] * r6);
    return {l.fx * (x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x)) + l.cx,
            l.fy * (y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y) + l.cy};
}

// OpenCV, fisheye: theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).
glm::dvec2 openCvFisheye(const Intrinsics& l, double x, double y) {
    const auto& d = l.distortion;
    const double r = std::sqrt(x * x + y * y), t = std::atan(r);
    const double bent =
        t * (1 + d[0] * t * t + d[1] * std::pow(t, 4) + d[2] * std::pow(t, 6) + d[3] * std::pow(t, 8));
    const double scale = r > 0 ? bent / r : 1;
    return {l.fx * x * scale + l.cx, l.fy * y * scale + l.cy};
}

// librealsense, rs2_project_point_to_pixel for the inverse and the modified Brown-Conrady model.
glm::dvec2 realSense(const Intrinsics& l, double x, double y) {
    const auto& d = l.distortion;
    const double r2 = x * x + y * y;
    const double f = 1 + d[0] * r2 + d[1] * r2 * r2 + d[4] * r2 * r2 * r2;
    const double u = x * f, v = y * f;
    return {l.fx * (u + 2 * d[2] * u * v + d[3] * (r2 + 2 * u * u)) + l.cx,
            l.fy * (v + 2 * d[3] * u * v + d[2] * (r2 + 2 * v * v)) + l.cy};
}

template <class Formula>
void checkAll(const Intrinsics& l, Formula formula) {
    CHECK(l.invertible());
    for (uint32_t v = 0; v < l.height; v += 7) {
        for (uint32_t u = 0; u < l.width; u += 7) {
            const glm::dvec2 ray = l.ray(u, v), there = formula(l, ray.x, ray.y);
            REQUIRE(std::abs(there.x - u) < kTolerance);
            REQUIRE(std::abs(there.y - v) < kTolerance);
            const glm::dvec2 back = l.project({0.7 * ray.x, 0.7 * ray.y, 0.7});
            REQUIRE(std::abs(back.x - there.x) < 1e-9);
            REQUIRE(std::abs(back.y - there.y) < 1e-9);
        }
    }
}

} // namespace

TEST_CASE("A lens with a rational polynomial follows OpenCV's formula, both ways") {
    // Colour lens of an Azure Kinect.
    checkAll(
        lens(LensModel::Polynomial, {0.4986, -2.6556, 0.00065, -0.00026, 1.537}, {0.3782, -2.483, 1.464}),
        openCv);
    checkAll(lens(LensModel::Polynomial, {5.27, 3.43, -0.00009, 0.00004, 0.178}, {5.6, 5.1, 0.91}), openCv);
    checkAll(lens(LensModel::Polynomial, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}), openCv);
}

TEST_CASE("An equidistant lens follows OpenCV's fisheye formula, both ways") {
    Intrinsics wide = lens(LensModel::Equidistant, {-0.0187, 0.0087, -0.0132, 0.0049, 0.0});
    checkAll(wide, openCvFisheye);
    wide.fx = wide.fy = 290.0; // 78 degrees from the axis in the corners
    checkAll(wide, openCvFisheye);
    checkAll(lens(LensModel::Equidistant, {}), openCvFisheye); // no coefficients: still not a pinhole
    CHECK_FALSE(lens(LensModel::Equidistant, {}).pinhole());
    wide.fx = wide.fy = 200.0; // more than 85 degrees
    CHECK_FALSE(wide.invertible());
}

TEST_CASE("The inverse Brown-Conrady lens of RealSense follows the SDK's projection, both ways") {
    // Colour lens of a D455.
    checkAll(lens(LensModel::ScaledTangential, {-0.0565362684428692, 0.068201869726181, 0.0003659751964733,
                                                0.000692575704306364, -0.0218431670218706}),
             realSense);
}

TEST_CASE("A point that a lens folds back into its image is not seen there") {
    // Depth lens of TUM freiburg2: monotone up to 34 degrees from the axis.
    Intrinsics tum = lens(LensModel::Polynomial, {-0.2297, 1.4766, 0.0005, -0.0075, -3.4194});
    tum.width = 640, tum.height = 480;
    tum.fx = 580.8, tum.fy = 581.8, tum.cx = 308.8, tum.cy = 253.0;
    CHECK(tum.reach() > 0.66);
    CHECK(tum.reach() < 0.68);
    for (const double slope : {0.1, 0.3, 0.5}) {
        CHECK(tum.project({slope, 0.0, 1.0}).x == doctest::Approx(openCv(tum, slope, 0.0).x));
    }
    for (const double slope : {0.75, 0.8, 0.85, 0.9}) { // the polynomial is inside the image here
        REQUIRE(openCv(tum, slope, 0.0).x < tum.width);
        REQUIRE(openCv(tum, slope, 0.0).x > 0.0);
        CHECK(tum.project({slope, 0.0, 1.0}).x == Intrinsics::kUnseen);
    }
    // A pole of the divisor, and an angle that turns back.
    CHECK(lens(LensModel::Polynomial, {}, {-0.5, 0.0, 0.0}).reach() == doctest::Approx(std::sqrt(2.0)));
    CHECK(lens(LensModel::Equidistant, {-0.4, 0.0, 0.0, 0.0, 0.0}).reach() ==
          doctest::Approx(std::tan(std::sqrt(1.0 / 1.2))));
    CHECK(lens(LensModel::Polynomial, {}).reach() == Intrinsics::kMaxSlope);
}

TEST_CASE("A lens that folds its image is not invertible") {
    CHECK_FALSE(lens(LensModel::Polynomial, {-5.0, 0.0, 0.0, 0.0, 0.0}).invertible());
    CHECK_FALSE(lens(LensModel::Polynomial, {0.0, 0.0, 0.0, 0.0, 0.0}, {-20.0, 0.0, 0.0}).invertible());
    CHECK_FALSE(lens(LensModel::Equidistant, {-3.0, 0.0, 0.0, 0.0, 0.0}).invertible());
}
