// SPDX-License-Identifier: Apache-2.0
// Checks the other libraries' results on depth images against their documented formulas.
#include "apps/profile/peers/peers.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::peers;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

Intrinsics lensOf(uint32_t width, uint32_t height) {
    Intrinsics lens;
    lens.width = width, lens.height = height;
    lens.fx = 61.5, lens.fy = 60.25, lens.cx = 0.5 * width + 1.25, lens.cy = 0.5 * height - 0.75;
    return lens;
}

// A slanted surface with a step and noise.
std::vector<float> steppedImage(const Intrinsics& lens) {
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0.0f, 0.002f);
    std::vector<float> z;
    for (uint32_t v = 0; v < lens.height; ++v) {
        for (uint32_t u = 0; u < lens.width; ++u) {
            z.push_back((u < lens.width / 2 ? 0.6f : 0.9f) + 0.001f * static_cast<float>(v) + noise(random));
        }
    }
    return z;
}

// The formula of bilateralFilter away from the border: a disc of taps with Gaussians in pixels and in value.
double bilateralAt(const std::vector<float>& z, const Intrinsics& lens, int u, int v, int radius,
                   double pixels, double metres) {
    const double z0 = z[static_cast<size_t>(v) * lens.width + u];
    double sum = 0.0, weights = 0.0;
    for (int dv = -radius; dv <= radius; ++dv) {
        for (int du = -radius; du <= radius; ++du) {
            const double away = du * du + dv * dv;
            if (away <= radius * radius) {
                const double zk = z[static_cast<size_t>(v + dv) * lens.width + (u + du)];
                const double w =
                    std::exp(-away / (2 * pixels * pixels) - (zk - z0) * (zk - z0) / (2 * metres * metres));
                sum += w * zk, weights += w;
            }
        }
    }
    return sum / weights;
}

} // namespace

TEST_CASE("OpenCV's bilateral filter matches its formula to 20 um for any number of threads") {
    const Intrinsics lens = lensOf(53, 31);
    const auto z = steppedImage(lens);
    for (const auto& way : filterMethods(2, 3.5, 0.01)) {
        if (way.name.rfind("OpenCV", 0) != 0) {
            continue;
        }
        CAPTURE(way.name);
        const auto peer = way.make();
        peer->load({lens, z});
        peer->run();
        const auto out = peer->depths();
        REQUIRE(out.size() == z.size());
        double worst = 0.0, moved = 0.0;
        for (int v = 2; v + 2 < 31; ++v) {
            for (int u = 2; u + 2 < 53; ++u) {
                const size_t i = static_cast<size_t>(v) * 53 + u;
                worst = std::max(worst, std::abs(out[i] - bilateralAt(z, lens, u, v, 2, 3.5, 0.01)));
                moved = std::max(moved, std::abs(static_cast<double>(out[i] - z[i])));
            }
        }
        CHECK(worst < 2e-5);
        CHECK(moved > 1e-3); // the filter has an effect
    }
}

TEST_CASE("Every filter keeps the step, smooths the noise and adds no depth to unmeasured pixels") {
    const Intrinsics lens = lensOf(64, 47);
    auto z = steppedImage(lens);
    z[5 * 64 + 9] = z[40 * 64 + 60] = kNone;
    for (const auto& way : filterMethods(3, 4.0, 0.02)) {
        CAPTURE(way.name);
        const auto peer = way.make();
        peer->load({lens, z});
        peer->run();
        const auto out = peer->depths();
        REQUIRE(out.size() == z.size());
        double before = 0.0, after = 0.0, step = 0.0;
        for (uint32_t v = 10; v < 37; ++v) {
            for (uint32_t u = 4; u < 60; ++u) {
                const size_t i = static_cast<size_t>(v) * 64 + u;
                const double truth = (u < 32 ? 0.6 : 0.9) + 0.001 * v;
                before += std::pow(z[i] - truth, 2), after += std::pow(out[i] - truth, 2);
                step = std::max(step, std::abs(out[i] - truth));
            }
        }
        CHECK(after < 0.5 * before);
        CHECK(step < 0.05);
        CHECK(std::isnan(out[5 * 64 + 9]));
        CHECK(std::isnan(out[40 * 64 + 60]));
    }
}

TEST_CASE("A filter does not change a constant image") {
    const Intrinsics lens = lensOf(17, 9);
    const std::vector<float> z(lens.pixels(), 0.75f);
    for (const auto& way : filterMethods(2, 2.0, 0.01)) {
        CAPTURE(way.name);
        const auto peer = way.make();
        peer->load({lens, z});
        peer->run();
        for (const float out : peer->depths()) {
            CHECK(out == doctest::Approx(0.75).epsilon(1e-6));
        }
    }
}

TEST_CASE(
    "OpenCV's points match the deprojected pixels in float32, and pixels without a measurement have none") {
    for (const auto& [width, height] : {std::pair{1u, 1u}, std::pair{37u, 23u}, std::pair{640u, 3u}}) {
        const Intrinsics lens = lensOf(width, height);
        std::vector<uint16_t> raw;
        for (uint32_t i = 0; i < lens.pixels(); ++i) {
            raw.push_back(static_cast<uint16_t>(i % 5 == 4 ? 0 : 400 + (i * 37) % 1700));
        }
        for (const auto& way : pointMethods()) {
            CAPTURE(way.name);
            const auto peer = way.make();
            peer->load(lens, raw);
            peer->run();
            const auto points = peer->points();
            REQUIRE(points.size() == raw.size());
            size_t wrong = 0;
            for (uint32_t i = 0; i < lens.pixels(); ++i) {
                const double z = 0.001 * raw[i];
                const glm::dvec2 ray = lens.ray(i % width, i / width);
                const dvec3 truth(ray.x * z, ray.y * z, z);
                const double off = glm::length(points[i] - truth);
                wrong += raw[i] == 0 ? !std::isnan(points[i].z) : !(off < 5e-7 * (1.0 + glm::length(truth)));
            }
            CHECK(wrong == 0);
        }
    }
}
