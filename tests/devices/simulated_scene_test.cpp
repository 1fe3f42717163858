// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/simulated_camera.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <optional>

using namespace fathom;

namespace {

struct Hsl {
    double hue, saturation, lightness;
};

Hsl hslOf(uint32_t packed) {
    const double r = (packed & 255) / 255.0, g = (packed >> 8 & 255) / 255.0,
                 b = (packed >> 16 & 255) / 255.0;
    const double most = std::max({r, g, b}), least = std::min({r, g, b}), chroma = most - least;
    const double lightness = 0.5 * (most + least);
    if (chroma == 0.0) {
        return {-1.0, 0.0, lightness};
    }
    double sextant = most == r   ? (g - b) / chroma
                     : most == g ? 2.0 + (b - r) / chroma
                                 : 4.0 + (r - g) / chroma;
    sextant = sextant < 0.0 ? sextant + 6.0 : sextant;
    return {60.0 * sextant, chroma / (1.0 - std::abs(2.0 * lightness - 1.0)), lightness};
}

bool inBand(const Hsl& c, double lo, double hi) {
    const bool hue = lo <= hi ? c.hue >= lo && c.hue <= hi : c.hue >= lo || (c.hue >= 0.0 && c.hue <= hi);
    return hue && c.saturation >= 0.4 && c.saturation <= 1.0 && c.lightness >= 0.08 && c.lightness <= 0.9;
}

// The twin of the ray caster: tests every solid.
RayHit firstHit(const AnalyticScene& scene, const Ray& ray) {
    RayHit hit{HUGE_VAL, -1};
    for (size_t i = 0; i < scene.solids.size(); ++i) {
        const std::optional<double> t = enter(scene.solids[i], ray);
        if (t && *t < hit.distance) {
            hit = {*t, static_cast<int32_t>(i)};
        }
    }
    return hit;
}

} // namespace

TEST_CASE("Every built-in scene is known by its name and any other name is not") {
    CHECK(analyticSceneNames().size() == 9);
    for (const std::string& name : analyticSceneNames()) {
        const std::optional<AnalyticScene> scene = analyticScene(name);
        REQUIRE(scene.has_value());
        CHECK(scene->name == name);
        CHECK_FALSE(scene->solids.empty());
        CHECK(scene->objects.at(0) == "surroundings");
        CHECK(signedDistance(*scene, dvec3(0.0)) > 0.1); // the camera starts in free space
        for (const Solid& solid : scene->solids) {
            CHECK(solid.object < scene->objects.size());
        }
    }
    CHECK_FALSE(analyticScene("").has_value());
    CHECK_FALSE(analyticScene("tan").has_value());
}

TEST_CASE("The tiled ray caster sees what a test of every solid sees, from every pose of the sway") {
    for (const std::string& name : analyticSceneNames()) {
        CAPTURE(name);
        SimulatedCameraOptions options;
        options.width = 161, options.height = 123;
        const SimulatedCamera camera(*analyticScene(name), options);
        for (const uint32_t frame : {0u, 77u, 200u}) {
            const SimulatedCamera::ExactView view = camera.exactView(frame);
            const Pose pose = camera.sceneTcamera(frame);
            double worst = 0.0, offSurface = 0.0;
            for (uint32_t pixel = 0; pixel < view.depth.size(); ++pixel) {
                const uint32_t column = pixel % options.width, row = pixel / options.width;
                const glm::dvec2 r = camera.info().depth.ray(column, row);
                const dvec3 ray(r.x, r.y, 1.0);
                const RayHit hit =
                    firstHit(camera.scene(), {pose.position, pose.rotation * glm::normalize(ray)});
                const double depth = hit.solid < 0 ? 0.0 : hit.distance / glm::length(ray);
                worst = std::fmax(worst, std::abs(depth - view.depth[pixel]));
                if (hit.solid >= 0) {
                    const dvec3 point = pose.apply(ray * view.depth[pixel]);
                    REQUIRE(view.solid[pixel] >= 0); // which of two that meet there may differ
                    const Solid& solid = camera.scene().solids[view.solid[pixel]];
                    offSurface = std::fmax(offSurface, std::abs(signedDistance(camera.scene(), point)));
                    offSurface = std::fmax(offSurface, std::abs(signedDistance(solid, point)));
                }
            }
            CHECK(worst < 1e-9);
            CHECK(offSurface < 1e-9);
        }
    }
}

TEST_CASE("In the tank the red and the yellow band select the two valves and hardly anything else") {
    const struct {
        double lo, hi;
        uint8_t object;
    } bands[] = {{345.0, 20.0, 1}, {40.0, 70.0, 2}};
    for (const uint32_t number : {0u, 67u, 134u, 201u}) {
        SimulatedCameraOptions options;
        options.firstFrame = number;
        SimulatedCamera camera(*analyticScene("tank"), options);
        const std::optional<Frame> frame = camera.next();
        REQUIRE(frame.has_value());
        const SimulatedCamera::ExactView truth = camera.exactView(number);
        for (const auto& band : bands) {
            uint32_t selected = 0, right = 0, valve = 0;
            for (size_t i = 0; i < truth.solid.size(); ++i) {
                const bool on =
                    truth.solid[i] >= 0 && camera.scene().solids[truth.solid[i]].object == band.object;
                const bool in = inBand(hslOf((*frame)->colour[i]), band.lo, band.hi);
                selected += in, right += in && on, valve += on;
            }
            MESSAGE("frame ", number, " ", camera.scene().objects[band.object], ": ", selected, " selected, ",
                    right, " on the valve of ", valve);
            CHECK(valve > 2000);
            CHECK(right > 0.97 * selected);
            CHECK(right > 0.85 * valve);
        }
    }
}

TEST_CASE("The valves of the tank stand so far apart that two regions of 4 cm leave room between them") {
    const AnalyticScene tank = *analyticScene("tank");
    double least = HUGE_VAL;
    for (const Solid& red : tank.solids) {
        for (int i = 0; red.object == 1 && red.kind == SolidKind::Torus && i < 720; ++i) {
            const double angle = i * std::acos(-1.0) / 360.0;
            const dvec3 rim = dvec3(std::cos(angle), std::sin(angle), 0.0) * red.size.x * red.localTscene;
            for (const Solid& yellow : tank.solids) {
                if (yellow.object == 2) {
                    least = std::min(least, signedDistance(yellow, red.position + rim) - red.size.y);
                }
            }
        }
    }
    CHECK(least > 2.0 * 0.04 + 0.05);
    CHECK(least < 0.30);
}
