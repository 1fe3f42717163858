// SPDX-License-Identifier: Apache-2.0
// Pressed regions that vanish: tool and hand stay, and the force fades out, whatever else is there.
#include "tests/cycle/arm_cycle_rig.h"

#include <doctest/doctest.h>

#include <array>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kFade = 0.2; // [s]

Shape planeAt(const dvec3& point, const dvec3& turn) { // its normal is z, turned
    Shape plane;
    plane.kind = ShapeKind::Plane;
    plane.baseTshape = {point, rotationExp(turn)};
    return plane;
}

const Shape kFloor = planeAt({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
const Shape kWall = planeAt({0.03, 0.0, 0.0}, {0.0, -0.5 * M_PI, 0.0}); // faces -x

// Placed shapes only.
struct ShapesRig : HapticRig {
    explicit ShapesRig(std::vector<Shape> all, const Scene& wanted = {})
        : HapticRig(wanted, at(0.0, 0.0, 0.02)) {
        cycle = std::make_unique<HapticCycle>(tool, all, options, hand);
        ticks(300);
    }
    void move(const Pose& to, int count) {
        const dvec3 by = (to.position - hand.position) / double(count);
        for (int i = 0; i < count; ++i) {
            hand.position += by;
            step();
        }
        hand = to;
    }
};

// Largest travel of the tool in a tick, over `count` ticks; each tick has less force than the one before.
double travelOf(HapticRig& rig, int count, double force) {
    double most = 0.0;
    Pose before = rig.cycle->pose();
    for (int i = 0; i < count; ++i) {
        const StepRecord record = rig.step();
        most = std::max(most, glm::distance(record.tool.position, before.position));
        CHECK(forceOf(record) < force);
        force = forceOf(record) + 1e-9;
        before = record.tool;
    }
    return most;
}

// A rod with a ball at either end. One ball is above a region, the other one below another region: together
// they hold the rod against a turn about y, by torque alone.
struct HeldRod : HapticRig {
    explicit HeldRod(bool pushed)
        : HapticRig(handScene(), at(0, 0, 0), Tool(buildSphereTree(kBalls))) {
        showRegions(true, 1);
        ticks(250);
        for (int i = 1; i <= 600; ++i) {
            hand = {{0.0, pushed ? 0.00001 * i : 0.0, 0.0}, rotationExp({0.0, 0.001 * i, 0.0})};
            step();
        }
        ticks(600);
    }
    void showRegions(bool held, uint64_t generation) {
        HostFixtures set = emptySet(generation);
        for (const double side : {-1.0, 1.0}) {
            set.spheres.add({side * 0.05, 0.0605, 0.0}, 0.05); // next to it
            if (held) {
                set.spheres.add({side * 0.05, 0.0, -side * 0.0605}, 0.05);
            }
        }
        show(std::move(set));
        sceneAges = false;
    }
    static constexpr std::array<Sphere, 2> kBalls{Sphere{{-0.05, 0.0, 0.0}, 0.01},
                                                  Sphere{{0.05, 0.0, 0.0}, 0.01}};
};

} // namespace

TEST_CASE(
    "A placed shape that is removed while it presses leaves the tool where it is, also without points") {
    ShapesRig rig({kFloor, kWall});
    rig.move(at(0.035, 0.0, 0.02), 200);
    const double force = forceOf(rig.ticks(1000));
    REQUIRE(force == doctest::Approx(15.0).epsilon(0.01));
    rig.cycle->setShapes(std::array{kFloor});
    CHECK(travelOf(rig, 199, force) <= 0.0003);
    CHECK(rig.step().vanished == 1);
    CHECK(forceOf(rig.ticks(5)) == 0.0);
}

TEST_CASE("If one of two pressed regions vanishes, its force fades out and the other one stays") {
    ShapesRig rig({kFloor, kWall});
    rig.move(at(0.035, 0.0, 0.009), 200);
    const StepRecord pressed = rig.ticks(1000);
    REQUIRE(pressed.wrench.force.x == doctest::Approx(-15.0).epsilon(0.01));
    REQUIRE(pressed.wrench.force.z == doctest::Approx(1.0).epsilon(0.01));
    rig.cycle->setShapes(std::array{kFloor});
    CHECK(travelOf(rig, 199, forceOf(pressed)) <= 0.0003);
    const StepRecord after = rig.ticks(5);
    CHECK(after.vanished == 1);
    CHECK(after.wrench.force.x == doctest::Approx(0.0));
    CHECK(after.wrench.force.z == doctest::Approx(1.0).epsilon(0.01));
    CHECK(after.tool.position.x - pressed.tool.position.x <= 0.0003);
}

TEST_CASE("With stiff springs one of two pressed regions that vanishes is noticed at a smaller depth") {
    Scene stiff;
    stiff.haptics.device = "omega";
    ShapesRig rig({kFloor, kWall}, stiff);
    REQUIRE(rig.options.springs.stiffness > 4000.0);
    rig.move(at(0.0224, 0.0, 0.0097), 200);
    const StepRecord pressed = rig.ticks(1000);
    REQUIRE(pressed.wrench.force.x < -10.0);
    rig.cycle->setShapes(std::array{kFloor});
    CHECK(travelOf(rig, 199, forceOf(pressed)) <= 0.0003);
    CHECK(rig.ticks(5).vanished == 1);
}

TEST_CASE("A hand that turns out of a region in one tick has lost no region") {
    HeldRod rig(false);
    rig.showRegions(true, 9);
    rig.hand.rotation = rotationExp({0.0, -0.3, 0.0});
    CHECK(rig.ticks(300).vanished == 0);
}

TEST_CASE("A wall that goes back under a hand is followed, not lost, also with a floor below") {
    ShapesRig rig({kFloor, kWall});
    rig.move(at(0.035, 0.0, 0.009), 200);
    rig.ticks(1000);
    Shape wall = kWall;
    wall.baseTshape.position.x += 0.008;
    rig.cycle->setShapes(std::array{kFloor, wall});
    const StepRecord after = rig.ticks(6000);
    CHECK(after.vanished == 0);
    CHECK(after.wrench.force.x == doctest::Approx(-7.0).epsilon(0.01));
    CHECK(after.tool.position.x == doctest::Approx(0.028).epsilon(0.001));
}

TEST_CASE("Another region next to the tool does not hide that the pressed one vanished") {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    const auto show = [&](bool pressed, double beside, uint64_t generation) {
        rig.show(pressed ? wallSet(generation) : emptySet(generation));
        rig.fixtures->spheres.add({0.0, 0.06 + beside, 0.01}, 0.05);
        rig.grid.build(rig.fixtures->spheres);
        rig.sceneAges = false;
    };
    show(true, 0.0015, 1);
    rig.ticks(250);
    rig.hand = at(0, 0, -0.005);
    const double force = forceOf(rig.ticks(1000));
    REQUIRE(force == doctest::Approx(15.0).epsilon(0.02));
    show(false, 0.0015, 2);
    CHECK(travelOf(rig, 199, force + 1e-9) <= 0.0003);
    CHECK(rig.step().vanished == 1);
}

TEST_CASE("A broken sample in the tick of a new frame costs that tick's force and nothing else") {
    auto rig = pressedRig();
    const Pose hand = rig.hand;
    rig.hand.position.x = std::nan("");
    rig.show(wallSet(9));
    rig.sceneAges = false;
    CHECK(forceOf(rig.step()) == 0.0);
    rig.hand = hand;
    const StepRecord after = rig.ticks(500);
    CHECK(after.vanished == 0);
    CHECK(forceOf(after) == doctest::Approx(5.0).epsilon(0.01));
}

TEST_CASE("A tool that a region turned does not swing round when the region vanishes") {
    const std::array<Sphere, 2> balls{Sphere{{-0.05, 0.0, 0.0}, 0.01}, Sphere{{0.05, 0.0, 0.0}, 0.01}};
    HapticRig rig(handScene(), at(0, 0, 0.03), Tool(buildSphereTree(balls)));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    for (int i = 1; i <= 500; ++i) {
        rig.hand = {{0.0, 0.0, 0.03 - 0.00003 * i}, rotationExp({0.0, 0.001 * i, 0.0})};
        rig.step();
    }
    const StepRecord held = rig.ticks(300);
    REQUIRE(glm::length(held.wrench.torque) > 0.1);
    rig.show(emptySet(9));
    rig.sceneAges = false;
    const auto tip = [](const Pose& tool) { return tool.position + tool.rotation * dvec3(0.05, 0.0, 0.0); };
    dvec3 before = tip(held.tool);
    for (int i = 0; i < 300; ++i) {
        const StepRecord record = rig.step();
        CHECK(glm::distance(tip(record.tool), before) <= 0.0003);
        before = tip(record.tool);
    }
    CHECK(glm::distance(before, tip(held.tool)) <= 0.001);
}

TEST_CASE("A torque without a force fades out when the regions that made it vanish, and does not step") {
    for (const bool pushed : {false, true}) { // into the regions next to it, which stay
        CAPTURE(pushed);
        HeldRod rig(pushed);
        const StepRecord held = rig.ticks(1);
        const double torque = held.wrench.torque.y;
        REQUIRE(std::abs(torque) > 0.1);
        REQUIRE(forceOf(held) == doctest::Approx(pushed ? 5.5 : 0.0).epsilon(0.05));
        rig.showRegions(false, 9);
        double before = torque;
        for (int i = 0; i < 199; ++i) {
            const StepRecord record = rig.step();
            const double now = record.wrench.torque.y;
            CHECK(std::abs(before - now) < 0.012 * std::abs(torque));
            CHECK(std::abs(now) <= std::abs(before) + 1e-4);
            CHECK(rotationBetween(held.tool.rotation, record.tool.rotation).y < 0.01);
            before = now;
        }
        const StepRecord after = rig.ticks(5);
        CHECK(after.vanished == 1);
        CHECK(std::abs(after.wrench.torque.y) < 0.01 * std::abs(torque));
        CHECK(forceOf(after) == doctest::Approx(forceOf(held)).epsilon(0.05));
    }
}

TEST_CASE("Late ticks do not delay the fade of regions that vanished") {
    for (const double period : {0.001, 0.002, 0.005}) {
        CAPTURE(period);
        auto rig = pressedRig();
        rig.measured = period;
        rig.ticks(1000);
        rig.show(emptySet(9));
        rig.sceneAges = false;
        const double begin = rig.time;
        rig.step();
        while (forceOf(rig.step()) > 0.0 && rig.time < begin + 1.0) {
        }
        CHECK(rig.time - begin <= kFade + 3.0 * period);
    }
}

TEST_CASE("A slow arm keeps its force while it follows a surface that goes back with the hand") {
    for (const double speed : {0.5, 3.0}) { // [rad/s] of the joints
        for (const double back : {0.1, 0.3}) {
            CAPTURE(speed);
            CAPTURE(back);
            ArmCycleRig arm({.speed = speed});
            for (int i = 0; i < 4000; ++i) {
                arm.hand = at(0.0, 0.12 * std::min(1.0, i / 2000.0), 0.0);
                arm.step();
            }
            double least = 1e9;
            StepRecord record = arm.step();
            const double force = forceOf(record);
            REQUIRE(force > 15.0);
            for (int i = 0; i < 198; ++i) {
                if (i % 33 == 0) {
                    arm.showBall(0.16 + back * (0.033 + 0.001 * i));
                }
                arm.hand.position.y += back * 0.001;
                record = arm.step();
                least = std::min(least, forceOf(record));
            }
            CHECK(record.vanished == 0);
            CHECK(least >= 0.9 * force);
        }
    }
}

TEST_CASE("A region that vanishes while guidance pulls leaves that pull as it is") {
    for (const double speed : {0.05, 0.15, 0.3}) { // [m/s] slower and faster than guidance
        CAPTURE(speed);
        HapticRig rig(handScene(), at(0, 0, 0.08));
        rig.show(wallSet());
        rig.sceneAges = false;
        rig.ticks(250);
        GuidancePose behind;
        behind.present = true;
        behind.target = at(0, 0, -0.3);
        rig.guidance = {behind};
        rig.buttons = kGuidanceButton;
        rig.ticks(600);
        StepRecord before = rig.step();
        while (rig.hand.position.z > -0.005) {
            rig.hand.position.z -= 0.001 * speed;
            before = rig.step();
        }
        REQUIRE(forceOf(before) > 14.0);
        rig.show(emptySet(9));
        rig.sceneAges = false;
        for (int i = 0; i < 150; ++i) {
            rig.hand.position.z -= 0.001 * speed;
            const StepRecord record = rig.step();
            CHECK(glm::distance(record.wrench.force, before.wrench.force) <= 0.2);
            before = record;
        }
        CHECK(before.vanished == 1);
    }
}
