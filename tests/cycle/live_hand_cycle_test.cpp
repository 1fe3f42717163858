// SPDX-License-Identifier: Apache-2.0
// Live devices in the haptic cycle: any start pose, recovery after a loss, axes without motors, slow ticks.
#include "tests/cycle/haptic_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A bar: a wall under one end rotates it.
Tool barTool() {
    std::vector<Sphere> leaves;
    for (int i = -4; i <= 4; ++i) {
        leaves.push_back({{0.01 * i, 0.0, 0.0}, 0.01});
    }
    return Tool(buildSphereTree(leaves));
}

} // namespace

TEST_CASE(
    "A tool that starts at a given pose stays there, wherever the hand is, and follows the hand's motion") {
    Scene scene = handScene();
    scene.hand.scale = 2.0;
    HapticRig rig(scene, at(0.3, -0.2, 0.135));
    const Pose start{{0.01, 0.0, 0.2}, rotationExp({0.0, 0.3, 0.0})};
    rig.cycle =
        std::make_unique<HapticCycle>(rig.tool, std::span<const Shape>{}, rig.options, rig.hand, &start);
    CHECK(rig.cycle->pose().position == start.position);
    rig.show(wallSet());
    rig.sceneAges = false;
    StepRecord record = rig.ticks(50);
    CHECK(glm::distance(record.tool.position, start.position) < 1e-12);
    CHECK(glm::length(record.wrench.force) < 1e-9);
    rig.hand.position.x += 0.005;
    record = rig.ticks(50);
    CHECK(record.tool.position.x == doctest::Approx(start.position.x + 0.01)); // twice the hand's motion
    CHECK(record.tool.rotation.y == doctest::Approx(start.rotation.y));
}

TEST_CASE(
    "A device that disappears and returns elsewhere, with dead-man and clutch, does not move the tool") {
    HapticRig rig(handScene("falcon"), at(0.0, 0.0, 0.05));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(300);
    rig.hand = at(0.0, 0.0, 0.008);
    CHECK(rig.ticks(300).wrench.force.z > 1.0); // pressed
    rig.buttons = 6;
    const StepRecord gone = rig.ticks(500);
    CHECK(glm::length(gone.deviceWrench.force) == 0.0);
    rig.hand = at(0.05, 0.03, -0.06); // unplugged and homed again
    rig.buttons = 0;
    const StepRecord back = rig.ticks(1);
    CHECK(glm::distance(back.tool.position, gone.tool.position) < 1e-6);
    CHECK(glm::distance(rig.ticks(500).tool.position, gone.tool.position) < 1e-6);
}

TEST_CASE(
    "A device of three axes gets force but no torque in any mounting, and the torque becomes residual") {
    for (const double angle : {0.0, 0.7, 2.5}) {
        Scene scene = handScene("falcon");
        scene.hand.baseRdevice = rotationExp({angle, 0.3 * angle, 0.0});
        HapticRig rig(scene, at(0.0, 0.0, 0.0), barTool());
        const Pose start = at(0.065, 0.0, 0.05);
        rig.cycle =
            std::make_unique<HapticCycle>(rig.tool, std::span<const Shape>{}, rig.options, rig.hand, &start);
        rig.show(wallSet()); // ends at x = 0.06, so only one end of the bar is above it
        rig.sceneAges = false;
        rig.ticks(300);
        const dvec3 down = glm::conjugate(scene.hand.baseRdevice) * dvec3(0.0, 0.0, -0.043);
        StepRecord record;
        for (int i = 1; i <= 400; ++i) {
            rig.hand.position = down * (i / 400.0);
            record = rig.step();
        }
        CHECK(glm::length(record.wrench.torque) > 1e-3);
        CHECK(glm::length(record.deviceWrench.torque) == 0.0);
        CHECK(glm::length(record.residual.torque) == doctest::Approx(glm::length(record.wrench.torque)));
        CHECK(glm::length(record.residual.force) < 1e-9);
        CHECK(glm::length(record.deviceWrench.force) == doctest::Approx(glm::length(record.wrench.force)));
        CHECK(glm::distance(scene.hand.baseRdevice * record.deviceWrench.force, record.wrench.force) < 1e-9);
    }
}

TEST_CASE("A sample more than 1000 km away counts as not finite, and does no lasting harm") {
    for (const double far : {1.1e6, 1e150, 1e300, 1e308}) {
        CAPTURE(far);
        auto rig = pressedRig();
        const double full = forceOf(rig.step());
        const Pose good = rig.hand;
        rig.hand = at(far, far, far);
        StepRecord record = rig.step();
        CHECK_FALSE(record.finite);
        CHECK(forceOf(record) == 0.0);
        rig.hand = good;
        record = rig.step();
        CHECK(record.finite);
        CHECK(forceOf(record) == doctest::Approx(0.1)); // the limit of 20 N rises from zero in 0.2 s
        CHECK(forceOf(rig.ticks(60)) == doctest::Approx(full));
    }
}

TEST_CASE("A turned bar leaves a wall at rest evenly, also on a device that renders no torque") {
    HapticRig rig(handScene("desktop"), at(0, 0, 0.03), barTool());
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    double most = 0.0, before = 0.0;
    for (int i = 0; i < 1200; ++i) {
        const double down = std::min(i, 400) / 400.0, up = std::max(0, i - 600) / 600.0; // 0.1 m/s
        rig.hand = {{0.0, 0.001, 0.03 - 0.034 * down + 0.06 * up}, rotationExp({0.0, 0.2 * down, 0.0})};
        const double force = forceOf(rig.step());
        CHECK(before - force < 0.4); // the spring's part is 0.1 N
        most = std::max(most, force);
        before = force;
    }
    CHECK(most > 5.0);
}

TEST_CASE("Slow ticks lower the automatic stiffness smoothly, the margin returns to 0, and lockstep is "
          "unaffected") {
    HapticRig rig(handScene(), at(0, 0, 0.05));
    StepInput input;
    input.deviceThandle = rig.hand;
    for (int i = 0; i < 300; ++i) { // no measured period
        rig.cycle->step(input);
    }
    CHECK(rig.cycle->springs().stiffness == 1000.0);
    input.measuredPeriod = 0.002;
    double before = 1000.0;
    StepRecord record;
    for (int i = 0; i < 400; ++i) {
        record = rig.cycle->step(input);
        const double now = rig.cycle->springs().stiffness;
        CHECK(now <= before);
        CHECK(before - now <= 10.0 + 1e-9);
        before = now;
        if (i == 0) {
            CHECK(record.marginPassive == doctest::Approx(-0.5));
        }
    }
    CHECK(before == doctest::Approx(500.0));
    CHECK(rig.cycle->springs().metricRadius == doctest::Approx(rig.options.springs.metricRadius));
    CHECK(std::abs(record.marginPassive) <= 1e-6);
    CHECK(std::abs(record.marginUncoupled) <= 1e-6);
}

TEST_CASE(
    "An orientation of non-unit length means the same orientation and sends no wrench through a dead axis") {
    HapticRig unit(handScene("w5d"), at(0, 0, 0.02)), scaled(handScene("w5d"), at(0, 0, 0.02));
    for (HapticRig* rig : {&unit, &scaled}) {
        rig->show(wallSet());
        rig->sceneAges = false;
    }
    for (int i = 0; i < 400; ++i) {
        unit.hand = {{0.0, 0.0, 0.02 - 4e-5 * i}, rotationExp({0.002 * i, 0.3, 0.004 * i})};
        scaled.hand = unit.hand;
        scaled.hand.rotation = scaled.hand.rotation * (i % 2 == 0 ? 1e-3 : 50.0);
        const auto a = unit.step(), b = scaled.step();
        REQUIRE(glm::distance(a.deviceWrench.force, b.deviceWrench.force) <= 1e-9);
        REQUIRE(glm::distance(a.deviceWrench.torque, b.deviceWrench.torque) <= 1e-9);
        REQUIRE(glm::distance(b.deviceWrench.force + b.residual.force, b.wrench.force) <= 1e-12);
    }
}
