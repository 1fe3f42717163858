// SPDX-License-Identifier: Apache-2.0
// Guidance: fading, saturation, choice, hold, slew, free roll, and both modes at rest.
#include "engine/haptics/guidance.h"
#include "engine/reference/rng.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace fathom;

namespace {

constexpr double kTick = 0.001;

GuidancePose poseAt(const dvec3& position, const dquat& rotation = {1, 0, 0, 0}) {
    GuidancePose pose;
    pose.present = true;
    pose.planar = true;
    pose.rollFree = false;
    pose.count = 100;
    pose.position = position;
    pose.target = {position, rotation};
    return pose;
}

Springs springs1000() {
    Springs springs;
    springs.stiffness = 1000.0;
    springs.rotationalStiffness = 0.4;
    springs.metricRadius = 0.02;
    springs.guidanceStiffness = 200.0;
    return springs;
}

void run(Guidance& guidance, const std::vector<GuidancePose>& poses, const Pose& device, bool button,
         int ticks) {
    for (int i = 0; i < ticks; ++i) {
        guidance.step(poses, device, button, false, kTick);
    }
}

} // namespace

TEST_CASE(
    "The weight fades over half a second by smoothstep, both ways, without a jump when reversed midway") {
    const std::vector<GuidancePose> poses{poseAt({0.1, 0, 0})};
    Guidance guidance;
    double before = 0.0;
    for (int i = 1; i <= 500; ++i) {
        guidance.step(poses, {}, true, false, kTick);
        const double s = i / 500.0;
        CHECK(guidance.weight() == doctest::Approx(s * s * (3.0 - 2.0 * s)).epsilon(1e-9));
        CHECK(guidance.weight() - before <= 1.5 / 500.0 + 1e-12);
        before = guidance.weight();
    }
    CHECK(guidance.weight() == 1.0);
    run(guidance, poses, {}, false, 250);
    CHECK(guidance.weight() == doctest::Approx(0.5));
    run(guidance, poses, {}, true, 1);
    CHECK(guidance.weight() == doctest::Approx(0.5).epsilon(0.02));
    run(guidance, poses, {}, false, 252);
    CHECK(guidance.weight() == 0.0);
    CHECK_FALSE(guidance.hasTarget());
}

TEST_CASE("The lead is clamped as a whole vector to F_g / K_t and tau_g / K_r") {
    Rng random(8);
    const auto springs = springs1000();
    for (int i = 0; i < 100; ++i) {
        const dquat turned = rotationExp(random.uniform(0.0, 3.0) * random.direction());
        const std::vector<GuidancePose> poses{poseAt(random.uniform(0.0, 0.01) * random.direction(), turned)};
        Guidance guidance;
        run(guidance, poses, {}, true, 3000);
        const auto lead = guidance.lead({}, springs);
        const dvec3 away = poses[0].target.position, turn = rotationLog(turned);
        CHECK(glm::length(lead.translation) == doctest::Approx(std::min(glm::length(away), 0.002)));
        CHECK(glm::length(lead.rotation) == doctest::Approx(std::min(glm::length(turn), 0.25)));
        CHECK(glm::length(glm::cross(lead.translation, away)) <= 1e-15);
        CHECK(glm::length(glm::cross(lead.rotation, turn)) <= 1e-12);
        const Wrench pull = guidance.pull({}, springs);
        CHECK(glm::length(pull.force) == doctest::Approx(std::min(200.0 * glm::length(away), 2.0)));
        CHECK(glm::length(pull.torque) == doctest::Approx(std::min(0.08 * glm::length(turn), 0.1)));
    }
}

TEST_CASE("The class nearest to the device at the button press is chosen and kept until release") {
    std::vector<GuidancePose> poses{poseAt({0.3, 0, 0}), poseAt({0.1, 0, 0}), poseAt({-0.2, 0, 0})};
    Guidance guidance;
    run(guidance, poses, {}, true, 1);
    CHECK(guidance.chosen() == 1);
    run(guidance, poses, {{-0.2, 0, 0}, {1, 0, 0, 0}}, true, 100); // another class is nearer now
    CHECK(guidance.chosen() == 1);
    run(guidance, poses, {{-0.2, 0, 0}, {1, 0, 0, 0}}, false, 1);
    run(guidance, poses, {{-0.2, 0, 0}, {1, 0, 0, 0}}, true, 1);
    CHECK(guidance.chosen() == 2);
    // A class that is not present is ignored; without any, the choice waits for the first.
    poses[0].present = poses[1].present = poses[2].present = false;
    Guidance waiting;
    run(waiting, poses, {}, true, 50);
    CHECK_FALSE(waiting.hasTarget());
    CHECK(waiting.weight() == 0.0);
    poses[0].present = true;
    run(waiting, poses, {}, true, 1);
    CHECK(waiting.chosen() == 0);
    run(waiting, {}, {}, true, 2000); // an empty list is a lost target, not a crash
    CHECK(waiting.weight() == 0.0);
}

TEST_CASE("A lost target is held for half a second, then fades out, and fades in again when it returns") {
    std::vector<GuidancePose> poses{poseAt({0.1, 0, 0})};
    Guidance guidance;
    run(guidance, poses, {}, true, 600);
    poses[0].present = false;
    poses[0].target.position = {5, 5, 5}; // the pose of a class with too few points is ignored
    run(guidance, poses, {}, true, 499);
    CHECK(guidance.weight() == 1.0);
    CHECK(guidance.target().position.x == doctest::Approx(0.1));
    run(guidance, poses, {}, true, 252);
    CHECK(guidance.weight() == doctest::Approx(0.5).epsilon(0.02));
    run(guidance, poses, {}, true, 300);
    CHECK(guidance.weight() == 0.0);
    poses[0] = poseAt({0.15, 0, 0});
    run(guidance, poses, {}, true, 1);
    CHECK(guidance.target().position.x == 0.15); // no force yet, so no slew from the old position
    run(guidance, poses, {}, true, 500);
    CHECK(guidance.weight() == 1.0);
}

TEST_CASE("A target that jumps is followed at 0.1 m/s and 0.5 rad/s and reached exactly") {
    std::vector<GuidancePose> poses{poseAt({0, 0, 0})};
    Guidance guidance;
    run(guidance, poses, {}, true, 500);
    poses[0] = poseAt({0.03, 0.04, 0}, rotationExp({0, 0, 0.2}));
    Pose before = guidance.target();
    for (int i = 0; i < 500; ++i) {
        guidance.step(poses, {}, true, false, kTick);
        CHECK(glm::distance(guidance.target().position, before.position) <= 1e-4 + 1e-12);
        CHECK(glm::length(rotationBetween(before.rotation, guidance.target().rotation)) <= 5e-4 + 1e-12);
        before = guidance.target();
        if (i == 249) {
            CHECK(before.position.x == doctest::Approx(0.015));
            CHECK(rotationLog(before.rotation).z == doctest::Approx(0.125));
        }
    }
    CHECK(glm::distance(before.position, {0.03, 0.04, 0}) <= 1e-12);
    run(guidance, poses, {}, true, 200);
    CHECK(glm::distance(guidance.target().position, {0.03, 0.04, 0}) <= 1e-15);
}

TEST_CASE("With free roll there is no torque about the axis, but the axis itself is aligned") {
    Rng random(9);
    const auto springs = springs1000();
    for (int i = 0; i < 30; ++i) {
        std::vector<GuidancePose> poses{
            poseAt({0, 0, 0}, rotationExp(random.uniform(0.0, 3.0) * random.direction()))};
        poses[0].rollFree = true;
        const Pose device{{0, 0, 0}, rotationExp(random.uniform(0.0, 3.0) * random.direction())};
        Guidance guidance;
        run(guidance, poses, device, true, 8000);
        const dvec3 turn = guidance.lead(device, springs).rotation;
        const dvec3 normal = poses[0].target.rotation * dvec3(0, 0, 1),
                    axis = device.rotation * dvec3(0, 0, 1);
        CHECK(std::abs(glm::dot(turn, normal)) <= 1e-12);
        CHECK(std::abs(glm::dot(guidance.pull(device, springs).torque, normal)) <= 1e-12);
        const dvec3 whole = axisTurn(device.rotation, poses[0].target.rotation);
        CHECK(glm::distance(rotationExp(whole) * axis, normal) <= 1e-12);
        CHECK(glm::length(glm::cross(turn, whole)) <= 1e-12);
        // A device that differs only by roll gets no torque.
        const Pose rolled{{0, 0, 0}, poses[0].target.rotation * rotationExp({0, 0, 2.0})};
        CHECK(glm::length(guidance.lead(rolled, springs).rotation) <= 1e-12);
        poses[0].planar = false; // the scene's fixed orientation includes its roll
        run(guidance, poses, rolled, true, 1000);
        CHECK(glm::length(guidance.lead(rolled, springs).rotation) == doctest::Approx(0.25));
    }
    // Opposite axes: half a turn about a perpendicular axis.
    const dvec3 half = axisTurn({1, 0, 0, 0}, rotationExp({3.14159265358979323846, 0, 0}));
    CHECK(glm::length(half) == doctest::Approx(3.14159265358979));
    CHECK(std::abs(half.z) <= 1e-12);
}

TEST_CASE("A cut takes the weight to zero within 0.2 s, however short it is, and requires a new press of the "
          "button") {
    const std::vector<GuidancePose> poses{poseAt({0.1, 0, 0})};
    Guidance guidance;
    run(guidance, poses, {}, true, 500);
    guidance.step(poses, {}, true, true, kTick);
    for (int i = 1; i < 199; ++i) {
        const double before = glm::length(guidance.lead({}, springs1000()).translation);
        guidance.step(poses, {}, true, i < 10, kTick);
        const double now = glm::length(guidance.lead({}, springs1000()).translation);
        CHECK(now < before);
        CHECK(before - now < 2e-5); // of 2 mm
    }
    run(guidance, poses, {}, true, 2);
    CHECK(guidance.weight() == 0.0);
    CHECK(glm::length(guidance.lead({}, springs1000()).translation) == 0.0);
    run(guidance, poses, {}, true, 500);
    CHECK(guidance.weight() == 0.0);
    run(guidance, poses, {}, false, 1);
    run(guidance, poses, {}, true, 500);
    CHECK(guidance.weight() == 1.0);
}

TEST_CASE("A press of the button while a cut pull fades out counts once it is gone") {
    const std::vector<GuidancePose> poses{poseAt({0.1, 0, 0})};
    Guidance guidance;
    run(guidance, poses, {}, true, 500);
    for (int i = 0; i < 20; ++i) {
        guidance.step(poses, {}, true, true, kTick);
    }
    run(guidance, poses, {}, false, 30);
    for (int i = 0; i < 150; ++i) {
        const double before = guidance.weight();
        run(guidance, poses, {}, true, 1);
        CHECK(guidance.weight() <= before);
    }
    run(guidance, poses, {}, true, 600);
    CHECK(guidance.weight() == 1.0);
}

TEST_CASE("At rest the hand feels at most F_g, and the pull ends at the target") {
    const auto springs = springs1000();
    const std::vector<GuidancePose> poses{poseAt({0.1, 0, 0})};
    Guidance guidance;
    run(guidance, poses, {}, true, 500);
    for (const double x : {0.0, 0.05, 0.0985, 0.0999, 0.1}) {
        const Pose device{{x, 0, 0}, {1, 0, 0, 0}};
        const auto lead = guidance.lead(device, springs);
        const Pose tool{device.position + lead.translation, rotationExp(lead.rotation)};
        const double force = couple(springs, tool, device).force.x;
        CHECK(force == doctest::Approx(std::min(2.0, 1000.0 * (0.1 - x))));
    }
}

TEST_CASE("Without a plane the stand-off keeps the direction that it had when guidance was switched on") {
    GuidancePose seen = poseAt({0.1, 0, 0});
    seen.planar = false;
    const auto lookFrom = [&](const dvec3& camera) {
        seen.standoff = 0.08 * glm::normalize(camera - seen.position);
        seen.target.position = seen.position + seen.standoff;
    };
    lookFrom({0.1, 0, -1});
    Guidance guidance;
    run(guidance, {seen}, {}, true, 600);
    CHECK(glm::distance(guidance.target().position, {0.1, 0, -0.08}) <= 1e-12);
    lookFrom({0.6, 0, -1}); // the camera sways: nothing moves
    run(guidance, {seen}, {}, true, 600);
    CHECK(glm::distance(guidance.target().position, {0.1, 0, -0.08}) <= 1e-12);
    seen.position.y = 0.01; // the valve moves: the target follows
    lookFrom({0.6, 0, -1});
    run(guidance, {seen}, {}, true, 600);
    CHECK(glm::distance(guidance.target().position, {0.1, 0.01, -0.08}) <= 1e-12);
    run(guidance, {seen}, {}, false, 600); // the next press takes the new direction
    run(guidance, {seen}, {}, true, 600);
    CHECK(glm::distance(guidance.target().position, seen.target.position) <= 1e-12);
    seen.planar = true; // a plane has a direction of its own, which is followed
    seen.target.position.z -= 0.02;
    run(guidance, {seen}, {}, true, 600);
    CHECK(glm::distance(guidance.target().position, seen.target.position) <= 1e-12);
}

TEST_CASE("What pulls never moves faster than the speed of the limits, however the hand moves") {
    const auto springs = springs1000();
    const std::vector<GuidancePose> poses{poseAt({0.5, 0.1, 0}, rotationExp({0, 0, 2.0}))};
    for (const double speed : {0.02, 0.1}) {
        GuidanceLimits limits;
        limits.speed = speed;
        Guidance guidance(limits);
        Pose hand;
        Rng random(3);
        double before = 1e9, fastest = 0.0;
        for (int i = 0; i < 4000; ++i) {
            // It rests, is slower, is faster, goes back, and shakes.
            const double v = i < 1000   ? 0.0
                             : i < 2000 ? 0.5 * speed
                             : i < 2200 ? 3.0 * speed
                             : i < 3000 ? -speed
                                        : 0.0;
            hand.position.x += v * kTick;
            hand.position.y = i < 3000 ? 0.0 : random.uniform(-1e-4, 1e-4);
            guidance.step(poses, hand, true, false, kTick, guidance.leadReach(springs));
            const dvec3 lead = guidance.lead(hand, springs).translation;
            const double left = glm::distance(guidance.target().position, hand.position + lead);
            const double self = v > speed ? v : 0.0; // the hand's own
            if (i > 0 && i < 3000) {
                fastest = std::max(fastest, (before - left) / kTick - self);
            }
            before = left;
            CHECK(glm::length(lead) <= 0.002 + 1e-12);
            if (i == 2199) {
                CHECK(glm::length(lead) == 0.0); // faster by itself: nothing pulls
            }
        }
        CHECK(fastest <= speed * (1.0 + 1e-6));
        CHECK(fastest >= 0.5 * speed);
        CHECK(glm::length(guidance.lead(hand, springs).translation) == doctest::Approx(0.002));
    }
}
