// SPDX-License-Identifier: Apache-2.0
// Fans of beams at equal angles, and the sigma of a beam.
#include "engine/types/camera_info.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;

TEST_CASE(
    "Neighbouring beams of a fan are equal angles apart, and every beam's points project to its pixel") {
    Intrinsics fan{.width = 61, .height = 41, .fx = 30.0, .fy = 25.0, .cx = 29.5, .cy = 21.0, .fan = true};
    CHECK_FALSE(fan.pinhole());
    CHECK_FALSE(fan.distorted());
    for (uint32_t v = 0; v < fan.height; v += 4) {
        for (uint32_t u = 0; u + 1 < fan.width; ++u) {
            const dvec3 here(fan.ray(u, v), 1.0), next(fan.ray(u + 1, v), 1.0);
            const double azimuth = std::atan2(next.x, 1.0) - std::atan2(here.x, 1.0);
            CHECK(azimuth == doctest::Approx(1.0 / 30.0).epsilon(1e-9));
            const double elevation = std::asin(here.y / glm::length(here));
            CHECK(elevation == doctest::Approx((v - 21.0) / 25.0).epsilon(1e-9));
            const glm::dvec2 back = fan.project(2.5 * here);
            CHECK(std::abs(back.x - u) < 1e-9);
            CHECK(std::abs(back.y - v) < 1e-9);
        }
    }
}

TEST_CASE("A beam's sigma grows with range by both its parts, and three sigma exceed its half width") {
    const BeamSigma beam{0.004, 0.001, 0.02};
    CHECK(beam.at(0.0) == doctest::Approx(0.004));
    const double across = 5.0 * std::tan(0.01) / std::sqrt(3.0);
    CHECK(beam.at(5.0) == doctest::Approx(std::sqrt(0.009 * 0.009 + across * across)));
    const BeamSigma wide{0.0, 0.0, 0.3};
    CHECK(3.0 * wide.at(2.0) > 2.0 * std::tan(0.15));
    CameraInfo camera;
    CHECK(camera.sigmaAt({3.0, 0.0, 2.0}) == depthSigma(2.0)); // that of a camera, along the axis
    camera.beam = beam;
    CHECK(camera.sigmaAt({3.0, 0.0, 4.0}) == doctest::Approx(beam.at(5.0)));
}
