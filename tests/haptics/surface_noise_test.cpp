// SPDX-License-Identifier: Apache-2.0
// What a hand feels of a surface that each frame of a sensor shows a little elsewhere.
#include "engine/haptics/reaction.h"
#include "engine/haptics/surface_noise.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;

namespace {

constexpr double kTick = 0.001;         // [s]
constexpr int kFrame = 33;              // [ticks]
constexpr double kSensorNoise = 0.0005; // [m]

// A hand at rest below a surface that noise moves in every frame, at 1000 N/m.
struct RestingHand {
    explicit RestingHand(double depth, double sigma = kSensorNoise)
        : noise(0.0, sigma)
        , hand(-depth) {
        for (double z = 0.0; z > -depth; z -= 1e-4) {
            step(z);
        }
        rest(1000);
    }
    double step(double z) { // [N] along the normal
        if (ticks++ % kFrame == 0) {
            tick.newData = true;
            tick.allowed.position = tick.springEnd.position;
            tick.allowed.position.z = surface;
            tick.allowed.position += dvec3(across, 0.0, 1.0) * draw();
        }
        tick.springs.stiffness = 1000.0;
        tick.springs.rotationalStiffness = 1.0;
        tick.springs.metricRadius = std::sqrt(1e-3);
        tick.period = kTick;
        tick.springEnd.position.z = hand = z;
        wrench = reaction.step(tick);
        tick.newData = false;
        return wrench.force.z;
    }
    double draw() { return noise.stddev() > 0.0 ? noise(random) : 0.0; }
    void rest(int count) {
        for (int i = 0; i < count; ++i) {
            step(hand);
        }
    }
    // [N] RMS of the force about its mean, over `count` ticks.
    double ripple(int count) {
        dvec3 sum{0.0};
        double squares = 0.0;
        for (int i = 0; i < count; ++i) {
            step(hand);
            sum += wrench.force;
            squares += glm::dot(wrench.force, wrench.force);
        }
        mean = sum / double(count);
        return std::sqrt(std::max(0.0, squares / count - glm::dot(mean, mean)));
    }

    std::mt19937 random{7};
    std::normal_distribution<double> noise;
    double hand, surface = 0.0; // [m]
    double across = 0.0;        // of the noise, per part along the normal
    int ticks = 0;
    Reaction reaction;
    ReactionInput tick;
    Wrench wrench;
    dvec3 mean{0.0};
};

} // namespace

TEST_CASE("A resting hand feels the mean of a noisy surface, and a twelfth of its noise") {
    for (const double depth : {0.005, 0.02}) {
        for (const double across : {0.0, 2.0}) {
            CAPTURE(depth);
            CAPTURE(across);
            RestingHand felt(depth);
            felt.across = depth > 0.01 ? across : 0.25 * across;
            felt.rest(1000);
            const double noise = 1000.0 * kSensorNoise * std::sqrt(1.0 + felt.across * felt.across);
            CHECK(felt.ripple(6000) < noise / 12.0);
            CHECK(std::abs(felt.mean.z - 1000.0 * depth) < 0.15);
        }
    }
}

TEST_CASE("Nearly half of a motion within the noise is felt within a second, and all of it in three") {
    for (const double sigma : {0.0, 0.0001, 0.0003}) {
        for (const double change : {0.001, -0.001, 0.0018}) {
            CAPTURE(sigma);
            CAPTURE(change);
            RestingHand felt(0.02, sigma);
            felt.rest(4000);
            felt.surface = change;
            felt.rest(1000);
            CHECK((felt.wrench.force.z - 20.0) / (1000.0 * change) > 0.45);
            felt.rest(2000);
            CHECK((felt.wrench.force.z - 20.0) / (1000.0 * change) == doctest::Approx(1.0).epsilon(0.15));
        }
    }
}

TEST_CASE("The felt surface follows a slow one closer than its noise") {
    RestingHand felt(0.02);
    felt.rest(4000);
    double late = 0.0;
    for (int i = 0; i < 4000; ++i) {
        felt.surface += 1e-3 * kTick; // 1 mm/s
        felt.rest(1);
        late += i < 2000 ? 0.0 : (1000.0 * felt.surface + 20.0 - felt.wrench.force.z) / 2000.0;
    }
    CHECK(late < 0.6);
}

TEST_CASE("After seconds at rest the hand's own motion is still felt in the same tick") {
    RestingHand felt(0.01);
    felt.rest(5000);
    for (int i = 1; i <= 100; ++i) {
        const double before = felt.wrench.force.z;
        const bool newFrame = felt.ticks % kFrame == 0;
        felt.step(felt.hand - 5e-5);
        const double rise = felt.wrench.force.z - before;
        CHECK((newFrame || felt.ticks % kFrame < 14 || rise == doctest::Approx(0.05).epsilon(0.05)));
    }
}

TEST_CASE("A hand that moved elsewhere begins a new mean") {
    const auto feltOutlier = [](double way) { // [1] share of a frame that is 0.5 mm off
        double felt[2];
        for (const bool off : {false, true}) {
            RestingHand rig(0.02, 0.0003);
            rig.rest(6000);
            for (int i = 0; i < 200; ++i) { // sideways, with the surface
                rig.tick.allowed.position.x = rig.tick.springEnd.position.x += way / 200.0;
                rig.step(rig.hand);
            }
            rig.rest(kFrame - rig.ticks % kFrame);
            rig.surface = off ? 0.0005 : 0.0;
            rig.rest(kFrame);
            rig.surface = 0.0;
            rig.rest(kFrame);
            felt[off] = rig.wrench.force.z;
        }
        return (felt[1] - felt[0]) / 0.5;
    };
    CHECK(feltOutlier(0.0) < 0.015);
    CHECK(feltOutlier(0.03) > 0.02);
    CHECK(feltOutlier(0.03) < 0.06);
}

TEST_CASE(
    "What frames shift across the reaction and a hand that slides undoes adds up to no sideways force") {
    SurfaceNoise noise;
    SurfaceNoiseInput tick;
    tick.stiffness = 1000.0;
    tick.byHand = 0.06; // [N] 60 mm/s
    double across = 0.0, felt = 0.0, spring = 0.0;
    for (int i = 0; i < 1100; ++i) {
        const bool frame = i % 11 == 0;
        across += frame ? 0.3 : -0.03; // lifted onto the next spheres, and down again along them
        tick.spring = {{across, 0.0, 10.0}, dvec3(0.0)};
        tick.dataPushes = frame;
        felt += noise.step(tick).force.x / 1100.0;
        spring += across / 1100.0;
    }
    CHECK(spring == doctest::Approx(0.15).epsilon(0.01));
    CHECK(std::abs(felt - spring) < 0.8); // of the 2 N that may be withheld
}
