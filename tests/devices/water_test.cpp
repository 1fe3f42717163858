// SPDX-License-Identifier: Apache-2.0
// Refraction at a flat port against exact rays: points in water, seen by two simulated eyes through the
// window.
#include "devices/water/water_camera.h"

#include "engine/types/error.h"
#include "tests/devices/one_frame.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kBaseline = 0.005; // [m] short: the model is that of stereo in the limit
const Intrinsics kAir{.width = 161, .height = 121, .fx = 150, .fy = 150, .cx = 80, .cy = 60};

// Slope in air of the ray that reaches a point `across` from the axis at depth z: by bisection on Snell's law
// itself.
double slopeInAir(const FlatPort& port, double across, double z) {
    double low = 0.0, high = 10.0;
    for (int i = 0; i < 80; ++i) {
        const double slope = 0.5 * (low + high);
        const double angle = std::asin(std::sin(std::atan(slope)) / port.index);
        const double reaches = port.distance * slope + (z - port.distance) * std::tan(angle);
        (reaches < across ? low : high) = slope;
    }
    return 0.5 * (low + high);
}

// Slopes in x and y at which an eye at x = eye sees the point.
glm::dvec2 seen(const FlatPort& port, const dvec3& p, double eye) {
    const glm::dvec2 sideways(p.x - eye, p.y);
    const double across = glm::length(sideways);
    return across > 0.0 ? sideways * (slopeInAir(port, across, p.z) / across) : glm::dvec2(0.0);
}

// z that stereo measures: baseline over difference of slopes, with the eyes left and right of the camera.
double measuredZ(const FlatPort& port, const dvec3& p) {
    return kBaseline / (seen(port, p, -0.5 * kBaseline).x - seen(port, p, 0.5 * kBaseline).x);
}

} // namespace

TEST_CASE("Slopes in water obey Snell's law") {
    const FlatPort port{0.05, 1.34};
    for (const double air : {0.0, 0.1, 0.5, 1.0, 1.7}) {
        const double water = waterSlope(port, air);
        CHECK(std::sin(std::atan(air)) == doctest::Approx(1.34 * std::sin(std::atan(water))).epsilon(1e-12));
    }
}

TEST_CASE("Points seen by stereo through a flat port are recovered within the error that the model reports") {
    for (const double distance : {0.0, 0.02, 0.06}) {
        const FlatPort port{distance, 1.34};
        const WaterLens water = inWater(kAir, port, 0.4, 1.6);
        double worst = 0.0, uncorrected = 0.0;
        for (double z = 0.4; z <= 1.61; z += 0.3) {
            for (double v = 0; v < 121; v += 10) {
                for (double u = 0; u < 161; u += 10) { // the point that this very pixel sees
                    const glm::dvec2 air = kAir.ray(u, v);
                    const double slope = glm::length(air);
                    const double across = distance * slope + (z - distance) * waterSlope(port, slope);
                    const dvec3 p(slope > 0.0 ? glm::dvec2(air * (across / slope)) : glm::dvec2(0.0), z);
                    const double zHere = measuredZ(port, p);
                    const float factor = water.factor[static_cast<size_t>(v) * 161 + static_cast<size_t>(u)];
                    const double found = distance + factor * (zHere - distance);
                    const glm::dvec2 ray = water.lens.ray(u, v);
                    worst = std::max(worst, glm::length(dvec3(ray * found, found) - p));
                    uncorrected = std::max(uncorrected, glm::length(dvec3(air * zHere, zHere) - p));
                }
            }
        }
        CHECK(worst <= water.worst + 1e-4);
        CHECK(worst > 0.3 * water.worst - 1e-4); // and the estimate is not far too large
        CHECK(water.worst < 0.02);
        CHECK(uncorrected > 0.3);
        MESSAGE("port " << distance << " m: off by " << 1e3 * worst << " mm of " << 1e3 * water.worst
                        << " reported, uncorrected " << 1e3 * uncorrected << " mm");
    }
}

TEST_CASE("A camera behind a port gives true depth, keeps holes, reports its uncertainty and releases the "
          "source's frame") {
    CameraInfo info;
    info.depth = info.colour = kAir;
    info.hasColour = false;
    const FlatPort port{0.03, 1.34};
    std::vector<uint16_t> depth(kAir.pixels(), 0);
    const size_t centre = 60 * 161 + 80;
    depth[centre] = static_cast<uint16_t>(std::lround(1e3 * measuredZ(port, {0, 0, 0.9})));
    depth[0] = 65535;
    auto source = std::make_unique<OneFrame>(info, depth);
    OneFrame& watched = *source;
    WaterCamera camera(std::move(source), port, 0.4, 1.6);
    CHECK(camera.info().sigma > 0.0);
    CHECK(camera.info().depth.fx > 1.25 * kAir.fx);
    {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[centre] == doctest::Approx(900).epsilon(0.004));
        CHECK((*frame)->depth[1] == 0);
        CHECK((*frame)->depth[0] == 65535);
        CHECK(watched.returned == 0);
    }
    CHECK(watched.returned == 1);
    CHECK_FALSE(camera.next());
}

TEST_CASE("Lenses that do not fit a flat port are rejected") {
    CameraInfo info;
    info.depth = info.colour = {.width = 64, .height = 48, .fx = 12, .fy = 12, .cx = 32, .cy = 24};
    CHECK_THROWS_AS(
        WaterCamera(std::make_unique<OneFrame>(info, std::vector<uint16_t>(64 * 48)), {0.03, 1.33}, 0.4, 1.6),
        BadInput);
    info.depth.fx = info.depth.fy = 60;
    info.depth.distortion[0] = 0.1;
    CHECK_THROWS_AS(
        WaterCamera(std::make_unique<OneFrame>(info, std::vector<uint16_t>(64 * 48)), {0.03, 1.33}, 0.4, 1.6),
        BadInput);
}
