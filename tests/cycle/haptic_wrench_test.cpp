// SPDX-License-Identifier: Apache-2.0
// The haptic step: guidance in both modes, projection, hand map, damping, options, repeatability, no
// allocation.
#include "tests/cycle/haptic_rig.h"

#include "engine/haptics/limits.h"
#include "engine/types/error.h"
#include "tests/haptics/allocation_count.cpp" // the same counter in this program

#include <doctest/doctest.h>

#include <cmath>

using namespace fathom;
using namespace fathom::testing;

namespace {

GuidancePose targetAt(const Pose& pose) {
    GuidancePose target;
    target.present = target.planar = true;
    target.rollFree = false;
    target.position = pose.position;
    target.target = pose;
    return target;
}

Scene guidedScene(Scene::Haptics::GuidanceMode mode) {
    Scene scene = handScene();
    scene.fixtures.emplace_back();
    scene.fixtures.back().role = Role::Guidance;
    scene.haptics.guidance = mode;
    return scene;
}

} // namespace

TEST_CASE("Guidance in mode target leads the hand by F_g / K_t, is felt as F_g, and never enters a region") {
    HapticRig rig(guidedScene(Scene::Haptics::GuidanceMode::Target), at(0, 0, 0.03));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.guidance = {targetAt({{0, 0, -0.02}, rotationExp({0, 0, 1.0})})}; // inside the wall
    rig.ticks(250);
    rig.buttons = kGuidanceButton;
    auto record = rig.ticks(2500); // the torque grows with the speed of the pull
    CHECK(record.guidance == 1.0);
    CHECK(record.guidanceClass == 0);
    CHECK(record.tool.position.z == doctest::Approx(0.028));
    CHECK(record.wrench.force.z == doctest::Approx(-2.0));
    CHECK(glm::length(record.wrench.torque) == doctest::Approx(0.1));
    rig.hand = at(0, 0, 0.0105); // the hand follows until the tool rests on the wall
    for (int i = 0; i < 300; ++i) {
        record = rig.step();
        CHECK(rig.gap() >= 0.0);
    }
    CHECK(record.wrench.force.z > -1.0); // only the remaining distance above the wall pulls
    rig.buttons = 0;
    record = rig.ticks(600);
    CHECK(record.guidance == 0.0);
    CHECK(record.wrench.force.z <= 1e-9); // the hand is above the wall: no distance remains
    CHECK(glm::length(record.wrench.force) <= 1e-9);
}

TEST_CASE("Guidance in mode paper adds a spring of its own, and both springs stay within the passive bound") {
    HapticRig rig(guidedScene(Scene::Haptics::GuidanceMode::Paper), at(0, 0, 0.03));
    CHECK(rig.options.springs.stiffness == doctest::Approx(800.0));
    CHECK(rig.options.springs.guidanceStiffness == doctest::Approx(200.0));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.guidance = {targetAt(at(0, 0, 0.033))};
    rig.buttons = kGuidanceButton;
    auto record = rig.ticks(700);
    CHECK(record.tool.position == record.device.position); // the tool itself follows the hand
    CHECK(record.wrench.force.z == doctest::Approx(200.0 * 0.003));
    CHECK(record.marginPassive == doctest::Approx(0.0));
    rig.guidance = {targetAt(at(0, 0, 0.2))};
    record = rig.ticks(2000);
    CHECK(record.wrench.force.z == doctest::Approx(2.0)); // saturated
}

TEST_CASE("The wrench that the device cannot render becomes the residual in the handle's frame, and the "
          "columns sum to the whole") {
    HapticRig rig(guidedScene(Scene::Haptics::GuidanceMode::Target), at(0, 0, 0.03));
    rig.options.device = devicePreset("w5d");
    rig.hand.rotation = rotationExp({1.2, 0.3, 0.0});
    rig.restart();
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.guidance = {targetAt({{0.01, 0, 0.03}, rotationExp({0.2, 1.4, 2.0})})};
    rig.buttons = kGuidanceButton;
    const auto record = rig.ticks(2500);
    const dvec3 roll = rig.hand.rotation * dvec3(0, 0, 1);
    CHECK(glm::length(record.wrench.torque) == doctest::Approx(0.1));
    CHECK(std::abs(glm::dot(record.wrench.torque, roll)) > 1e-3);
    CHECK(std::abs(glm::dot(record.deviceWrench.torque, roll)) <= 1e-12);
    CHECK(glm::distance(record.deviceWrench.torque + record.residual.torque, record.wrench.torque) <= 1e-12);
    CHECK(glm::length(glm::cross(record.residual.torque, roll)) <= 1e-12);
    CHECK(glm::length(record.residual.force) <= 1e-12);
}

TEST_CASE("A hand map of scale 2 moves the tool twice as far, and halves the stiffness and the torque at the "
          "hand") {
    Scene scene = handScene();
    scene.hand.scale = 2.0;
    scene.hand.baseRdevice = rotationExp({0, 0, 3.14159265358979323846 / 2.0});
    HapticRig rig(scene, at(0.01, 0, 0.015));
    CHECK(rig.options.springs.stiffness == doctest::Approx(500.0));
    CHECK(rig.cycle->pose().position.y == doctest::Approx(0.02));
    CHECK(rig.cycle->pose().position.z == doctest::Approx(0.03));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    rig.hand = at(0.01, 0, 0.0025);
    const auto record = rig.ticks(200);
    CHECK(record.device.position.z == doctest::Approx(0.005));
    CHECK(record.wrench.force.z == doctest::Approx(500.0 * (record.tool.position.z - 0.005)));
    CHECK(record.deviceWrench.force.z == doctest::Approx(record.wrench.force.z));
    CHECK(glm::distance(record.deviceWrench.force,
                        glm::conjugate(scene.hand.baseRdevice) * record.wrench.force) <= 1e-12);
    CHECK(record.marginPassive == doctest::Approx(0.0));
}

TEST_CASE("Damping acts on the speed of the hand along the force, and a scene without points needs no "
          "contact set") {
    Scene scene;
    scene.haptics.device = "ideal";
    scene.haptics.stiffness = 500.0;
    const Tool tool = ballTool();
    HapticOptions options = makeHapticOptions(springsAlone(scene), tool);
    CHECK_FALSE(options.needsContacts);
    options.springs.damping = 0.1;
    Shape plane;
    plane.kind = ShapeKind::Plane; // z <= 0 is forbidden
    HapticCycle cycle(tool, {&plane, 1}, options, at(0, 0, 0.03));
    StepInput input;
    StepRecord record;
    for (int i = 0; i < 500; ++i) {
        const double z = std::max(-0.01, 0.03 - 0.0001 * i); // 0.1 m/s down
        input.deviceThandle = at(0, 0, z);
        input.measuredPeriod = i == 250 ? 4.0 * options.period : 0.0;
        record = cycle.step(input);
        input.time += options.period;
        if (i == 249 || i == 250) { // tool at rest on the plane, hand still moving; the second tick is late
            const double speed = i == 249 ? 0.1 : 0.1 / 4.0;
            CHECK(record.state == StepState::Contact);
            CHECK(record.wrench.force.z - 500.0 * (0.01 - z) == doctest::Approx(0.1 * speed).epsilon(1e-3));
            CHECK(std::isnan(record.sceneAge));
            CHECK(record.frame == -1);
        }
    }
    CHECK(record.wrench.force.z == doctest::Approx(500.0 * 0.02).epsilon(1e-3));
    CHECK(record.tool.position.z >= 0.01);
}

TEST_CASE("Late ticks do not delay fading out and do not hasten the return of a force") {
    Scene scene = handScene();
    scene.haptics.stiffness = 1000.0; // set explicitly, so late ticks do not lower it
    HapticRig rig(scene, at(0.0, 0.0, 0.03));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(400);
    rig.hand = at(0.0, 0.0, 0.0);
    const double full = forceOf(rig.ticks(200));
    CHECK(full > 5.0);
    rig.measured = 0.005;
    rig.sceneAges = true;
    rig.scene.captureTime = rig.time - 0.1;
    CHECK(forceOf(rig.ticks(51)) == doctest::Approx(full / 2.0).epsilon(0.03));
    CHECK(forceOf(rig.ticks(52)) <= 1e-12); // 0.5 s
    rig.sceneAges = false;
    CHECK(forceOf(rig.ticks(51)) == doctest::Approx(20.0 * 51.0 / 500.0)); // 20 N in 0.5 s of nominal ticks
    CHECK(forceOf(rig.ticks(251)) == doctest::Approx(full));
}

TEST_CASE("Margins use the measured period if there is one, and are unknown without a known b") {
    HapticRig rig(handScene(), at(0, 0, 0.03));
    StepInput input;
    input.deviceThandle = rig.hand;
    input.measuredPeriod = 0.002;
    CHECK(rig.cycle->step(input).marginPassive == doctest::Approx(0.5 - 1000.0 * 0.002 / 2.0));
    HapticRig touch(handScene("touch"), at(0, 0, 0.03));
    CHECK(std::isnan(touch.cycle->step(input).marginPassive));
    CHECK(touch.options.springs.stiffness == 400.0);
    CHECK_THROWS_AS(HapticRig(handScene("nothing"), at(0, 0, 0)), BadInput);
}

TEST_CASE("The low-pass delay lowers the automatic stiffness, and limits of the scene override the preset") {
    Scene scene = handScene();
    scene.haptics.lowpassHz = 100.0;
    scene.haptics.forceLimit = 3.0;
    HapticRig rig(scene, at(0, 0, 0.02));
    const double n = lowPassDelayTicks(lowPassGain(100.0, 0.001));
    CHECK(n > 0.5);
    CHECK(rig.options.springs.stiffness == doctest::Approx(1000.0 / (1.0 + 2.0 * n)));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    rig.hand = at(0, 0, -0.05);
    const auto record = rig.ticks(300);
    CHECK(glm::length(record.wrench.force) == doctest::Approx(3.0));
    CHECK(record.marginPassive == doctest::Approx(0.0));
}

TEST_CASE(
    "A delay of n ticks to the hand lowers the automatic stiffness by 1 + 2n and leaves a margin of zero") {
    for (const uint32_t delay : {0u, 1u, 3u, 64u}) {
        Scene scene = handScene();
        scene.haptics.delay = delay;
        HapticRig rig(scene, at(0, 0, 0.02));
        CHECK(rig.options.springs.stiffness == doctest::Approx(1000.0 / (1.0 + 2.0 * delay)));
        CHECK(rig.options.deviceDelayTicks == delay);
        CHECK(std::abs(rig.step().marginPassive) < 1e-12);
    }
}

TEST_CASE("A set whose trust region the tool has left is rejected and the active one is kept") {
    HapticRig rig(handScene(), at(0, 0, 0.05));
    rig.show(wallSet(1));
    rig.sceneAges = false;
    REQUIRE(rig.step().adopted);
    ContactSet far;
    rig.cull.query(rig.tool, at(0.05, 0, 0.05), 0.01, wallSet(2), rig.grid, far);
    StepInput input = stepInput({rig.hand}, rig.time);
    input.active = rig.contacts.active();
    input.offered = &far;
    const auto record = rig.cycle->step(input);
    CHECK_FALSE(record.adopted);
    CHECK(record.frame == 1);
}

TEST_CASE("The same run twice gives the same bits, and steps do not allocate") {
    std::vector<StepRecord> first;
    for (int run = 0; run < 2; ++run) {
        HapticRig rig(guidedScene(Scene::Haptics::GuidanceMode::Target), at(0, 0, 0.02));
        rig.show(wallSet());
        rig.guidance = {targetAt({{0.02, 0, 0.012}, rotationExp({0.1, 0, 0})})};
        for (int i = 0; i < 400; ++i) {
            rig.hand = {{0.01 * std::sin(0.02 * i), 0.0, 0.012 - 0.00005 * i},
                        rotationExp({0.001 * i, 0, 0})};
            rig.buttons = i > 100 && i < 300 ? kGuidanceButton : i == 350 ? 4u : 0u;
            const auto record = rig.step();
            if (run == 0) {
                first.push_back(record);
                continue;
            }
            const StepRecord& before = first[static_cast<size_t>(i)];
            CHECK(record.tool.position == before.tool.position);
            CHECK(record.tool.rotation == before.tool.rotation);
            CHECK(record.wrench.force == before.wrench.force);
            CHECK(record.wrench.torque == before.wrench.torque);
        }
        StepInput input = stepInput({rig.hand}, rig.time);
        input.active = rig.contacts.active();
        input.guidance = rig.guidance;
        const uint64_t before = allocationCount();
        for (int i = 0; i < 200; ++i) {
            input.deviceThandle.position.x += 2e-5;
            input.buttons = static_cast<uint32_t>(i / 25);
            rig.cycle->step(input);
        }
        CHECK(allocationCount() == before);
    }
}

TEST_CASE("The springs' damping brakes a hand that leaves, and never pulls it back in") {
    for (const bool vanished : {false, true}) { // in the latter case from a force that fades
        CAPTURE(vanished);
        HapticRig rig(handScene(), at(0, 0, 0.02));
        rig.options.springs.damping = 20.0; // [N s/m]
        rig.options.passivityController = false;
        rig.restart();
        rig.show(wallSet());
        rig.sceneAges = false;
        rig.ticks(250);
        rig.hand = at(0, 0, 0.006);
        REQUIRE(rig.ticks(1000).wrench.force.z == doctest::Approx(4.0).epsilon(0.1));
        if (vanished) {
            rig.show(emptySet(2));
            rig.sceneAges = false;
            REQUIRE(rig.ticks(2).vanished == 1);
        }
        while (rig.hand.position.z < 0.012) {
            rig.hand.position.z += 0.0003;              // 0.3 m/s: the damper alone is 6 N
            CHECK(rig.step().wrench.force.z >= -1e-12); // rounding
        }
    }
}
