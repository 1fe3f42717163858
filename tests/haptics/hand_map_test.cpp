// SPDX-License-Identifier: Apache-2.0
// The hand map: formula, clutch, and no energy from closed paths of the hand at any scale.
#include "engine/haptics/coupling.h"
#include "engine/haptics/hand_map.h"
#include "engine/reference/rng.h"
#include "engine/types/error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace fathom;

namespace {

const dquat kTurned = rotationExp({0.4, -1.1, 0.7});

double angleBetween(const dquat& a, const dquat& b) {
    return glm::length(rotationBetween(b, a));
}

Pose randomPose(Rng& random) {
    return {0.1 * random.direction(), rotationExp(random.uniform(0.0, 3.0) * random.direction())};
}

} // namespace

TEST_CASE("With the defaults the device pose is the raw pose, and in general it is offset + s R raw") {
    Rng random(4);
    HandMap plain({1, 0, 0, 0}, 1.0), map(kTurned, 2.5);
    for (int i = 0; i < 500; ++i) {
        const Pose raw = randomPose(random);
        CHECK(plain.map(raw, false).position == raw.position);
        CHECK(angleBetween(plain.map(raw, false).rotation, raw.rotation) <= 1e-15);
        const Pose device = map.map(raw, false);
        CHECK(glm::distance(device.position, 2.5 * (kTurned * raw.position)) <= 1e-15);
        CHECK(angleBetween(device.rotation, kTurned * raw.rotation) <= 1e-14);
    }
}

TEST_CASE("A rotation of the hand about a base axis rotates the device pose about that axis, also after "
          "re-indexing") {
    Rng random(5);
    HandMap map(kTurned, 0.5);
    Pose raw = randomPose(random);
    map.map(raw, false);
    map.map(raw, true);
    raw = randomPose(random); // the hand moved while the clutch was down
    const Pose before = map.map(raw, false);
    const dvec3 turn = 0.3 * random.direction();
    raw.rotation = glm::conjugate(kTurned) * (rotationExp(turn) * (kTurned * raw.rotation));
    const Pose after = map.map(raw, false);
    CHECK(glm::distance(rotationBetween(before.rotation, after.rotation), turn) <= 1e-12);
}

TEST_CASE("The clutch holds the device pose and releases it without a jump") {
    Rng random(6);
    HandMap map(kTurned, 3.0);
    Pose raw = randomPose(random);
    Pose device = map.map(raw, false);
    for (int cycle = 0; cycle < 100; ++cycle) {
        const Pose held = device;
        for (int i = 0; i < 5; ++i) {
            device = map.map(randomPose(random), true);
            CHECK(device.position == held.position);
            CHECK(device.rotation == held.rotation);
        }
        raw = randomPose(random);
        device = map.map(raw, false);
        CHECK(glm::distance(device.position, held.position) <= 1e-14);
        CHECK(angleBetween(device.rotation, held.rotation) <= 1e-14);
        raw.position += dvec3(0.001, 0, 0);
        device = map.map(raw, false);
        CHECK(glm::distance(device.position, held.position + 3.0 * (kTurned * dvec3(0.001, 0, 0))) <= 1e-14);
    }
}

TEST_CASE("A clutch that is down in the first tick only holds the first pose, too") {
    HandMap map({1.0, 0.0, 0.0, 0.0}, 1.0);
    const Pose first = map.map({{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, true);
    const Pose next = map.map({{0.5, 0.2, 0.0}, rotationExp({0.0, 0.3, 0.0})}, false);
    CHECK(glm::distance(first.position, next.position) < 1e-12);
    CHECK(glm::length(rotationBetween(first.rotation, next.rotation)) < 1e-12);
}

TEST_CASE("A clutch that is down from the start holds the first pose") {
    HandMap map({1, 0, 0, 0}, 1.0);
    const Pose first{{0.1, 0.2, 0.3}, {1, 0, 0, 0}};
    CHECK(map.map(first, true).position == first.position);
    CHECK(map.map({{9, 9, 9}, {1, 0, 0, 0}}, true).position == first.position);
}

TEST_CASE("The wrench on the hand is R^T f and R^T tau / s, and a closed path of the hand gains no energy") {
    Springs springs;
    springs.stiffness = 500.0;
    springs.rotationalStiffness = 0.3;
    const Pose proxy{{0.05, 0.0, -0.02}, rotationExp({0.1, 0.2, 0.0})};
    for (const double scale : {0.2, 1.0, 4.0}) {
        HandMap map(kTurned, scale);
        const Wrench unit = map.toDevice({kTurned * dvec3(1, 0, 0), kTurned * dvec3(0, 2, 0)});
        CHECK(glm::distance(unit.force, {1, 0, 0}) <= 1e-15);
        CHECK(glm::distance(unit.torque, {0, 2.0 / scale, 0}) <= 1e-14);
        // A closed path with translation and rotation; work by the midpoint rule.
        const auto hand = [&](double s) {
            return Pose{dvec3(0.02 * std::sin(s), 0.03 * std::cos(s), 0.01 * std::sin(2.0 * s)) / scale,
                        rotationExp(dvec3(0.2 * std::cos(s), 0.0, 0.0)) *
                            rotationExp(dvec3(0.0, 0.3 * std::sin(s), 0.1))};
        };
        double work = 0.0, handled = 0.0;
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double step = 2.0 * std::numbers::pi / steps, s = step * i;
            const Pose a = hand(s), b = hand(s + step), middle = hand(s + 0.5 * step);
            const Wrench wrench = map.toDevice(couple(springs, proxy, map.map(middle, false)));
            const double part = glm::dot(wrench.force, b.position - a.position) +
                                glm::dot(wrench.torque, rotationBetween(a.rotation, b.rotation));
            work += part;
            handled += std::abs(part);
        }
        CAPTURE(scale);
        CHECK(handled > 1e-3);
        CHECK(std::abs(work) <= 1e-6 * handled);
    }
}

TEST_CASE("A scale that is not positive or a map that is not a rotation is rejected") {
    CHECK_THROWS_AS(HandMap({1, 0, 0, 0}, 0.0), Error);
    CHECK_THROWS_AS(HandMap({1, 0, 0, 0}, -1.0), Error);
    CHECK_THROWS_AS(HandMap({1, 0, 0, 0}, std::nan("")), Error);
    CHECK_THROWS_AS(HandMap({0.5, 0, 0, 0}, 1.0), Error);
}
