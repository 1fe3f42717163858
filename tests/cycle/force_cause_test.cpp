// SPDX-License-Identifier: Apache-2.0
// No force without a cause: late and lost contact answers, regions that disappear, devices that come and go.
#include "engine/cycle/haptic_notes.h"
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A wall of 120 mm and free space around it.
HapticRig slidingRig(size_t late) {
    HapticRig rig(handScene(), at(-0.12, 0.0, 0.006));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(300);
    rig.late = late;
    return rig;
}

// Comes from free space, slides 4 mm deep over the wall and leaves it.
Pose slidingHand(double t, double speed) {
    constexpr double kStart = 0.05; // [s] a hand does not start at once
    return at(-0.12 + speed * (t - kStart * (1.0 - std::exp(-t / kStart))), 0.0, 0.006);
}

// A bar of 50 mm across the roll axis, which lies along the wall.
HapticRig barRig(const char* device) {
    std::vector<Sphere> leaves;
    for (int i = 0; i <= 10; ++i) {
        leaves.push_back({{0.0, 0.005 * i, 0.0}, 0.01});
    }
    HapticRig rig(handScene(device), {{0.0, 0.0, 0.012}, rotationExp({0.0, 0.5 * M_PI, 0.0})},
                  Tool(buildSphereTree(leaves)));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(300);
    return rig;
}

} // namespace

TEST_CASE("With answers up to 20 ms late a hand of 0.5 m/s never waits, and feels what it would feel without "
          "delay") {
    for (const size_t late : {1u, 5u, 20u}) {
        CAPTURE(late);
        HapticRig now = slidingRig(0), delayed = slidingRig(late);
        uint32_t waits = 0, contacts = 0;
        double apart = 0.0;
        for (int i = 0; i < 530; ++i) {
            now.hand = delayed.hand = slidingHand(0.001 * i, 0.5);
            const StepRecord a = now.step(), b = delayed.step();
            waits += b.stalled || b.state == StepState::Waiting ? 1 : 0;
            contacts += b.contactCount > 0 ? 1 : 0;
            apart = std::max(apart, glm::distance(a.wrench.force, b.wrench.force));
            CHECK(delayed.gap() >= 0.0);
        }
        CHECK(waits == 0);
        CHECK(contacts > 100);
        CHECK(apart <= 1000.0 * 0.0005 + 0.05);
    }
}

TEST_CASE("With answers 50 and 100 ms late or lost at random there is no force without a contact") {
    std::mt19937 random(5);
    for (const size_t late : {50u, 100u}) {
        for (const double speed : {0.2, 1.0}) {
            CAPTURE(late);
            CAPTURE(speed);
            HapticRig rig = slidingRig(late);
            double before = 0.0;
            for (int i = 0; i < static_cast<int>(300.0 / speed); ++i) {
                rig.hand = slidingHand(0.001 * i, speed);
                rig.query = random() % 10 != 0;
                const StepRecord record = rig.step();
                const double force = forceOf(record);
                CHECK(rig.gap() >= 0.0);
                const bool free =
                    record.contactCount == 0 && (record.cause & (cause::kRow | cause::kDamping)) == 0;
                CHECK((!free || force <= 0.05 || force < before));
                before = force;
            }
        }
    }
}

TEST_CASE("A hand that is thrown at regions never leaves faster than it came, however late the answers are") {
    for (const size_t late : {0u, 1u, 5u, 20u, 50u, 100u}) {
        for (const double mass : {0.1, 0.4, 2.0}) { // [kg] light, default and firm hands
            for (const double speed : {0.1, 0.3, 0.5}) {
                CAPTURE(late);
                CAPTURE(mass);
                CAPTURE(speed);
                HapticRig rig(handScene(), at(0, 0, 0.03));
                rig.show(wallSet());
                rig.sceneAges = false;
                rig.ticks(250);
                rig.late = late;
                double v = -speed, fastest = 0.0;
                for (int i = 0; i < 1200; ++i) {
                    const double force = rig.step().wrench.force.z;
                    v += (force - 0.5 * v) * 0.001 / mass; // 0.5 N s/m: the damping of the ideal device
                    rig.hand.position.z += v * 0.001;
                    fastest = std::max(fastest, v);
                    REQUIRE(rig.gap() >= 0.0);
                }
                CHECK(fastest <= speed);
                CHECK((fastest > 0.3 * speed || mass * speed < 0.02)); // thrown back, unless damping stops it
            }
        }
    }
}

TEST_CASE(
    "A wrist turned in contact costs nothing on a device without that torque, and gives at most 1 mJ back") {
    for (const char* device : {"touch", "w5d"}) {
        CAPTURE(device);
        HapticRig rig = barRig(device);
        const dquat start = rig.hand.rotation;
        for (int i = 1; i <= 500; ++i) { // the hand stays where it is, so it gives no energy
            rig.hand.rotation = rotationExp({-0.001 * i, 0.0, 0.0}) * start;
            rig.step();
        }
        const double pressed = forceOf(rig.ticks(100));
        CHECK(pressed > 2.0);
        constexpr double kMass = 0.4; // [kg] let go
        double v = 0.0, most = 0.0;
        for (int i = 0; i < 1500; ++i) {
            v += rig.step().wrench.force.z * 0.001 / kMass;
            rig.hand.position.z += v * 0.001;
            most = std::max(most, 0.5 * kMass * v * v);
            REQUIRE(rig.gap() >= 0.0);
        }
        CHECK(rig.hand.position.z > 0.02); // it came out
        CHECK(most <= 1e-3);
    }
}

TEST_CASE("Regions that disappear while they press leave the tool where it is, and their force fades out") {
    auto rig = pressedRig();
    const StepRecord held = rig.step();
    REQUIRE(forceOf(held) == doctest::Approx(5.0).epsilon(0.01));
    rig.show(emptySet(9));
    rig.sceneAges = false;
    double before = forceOf(held) + 1e-9;
    StepRecord record;
    for (int i = 0; i < 199; ++i) {
        record = rig.step();
        CHECK(glm::distance(record.tool.position, held.tool.position) <= 0.0003);
        CHECK(forceOf(record) < before);
        before = forceOf(record);
    }
    CHECK(record.vanished == 1);
    CHECK(glm::distance(record.indexShift, held.tool.position - held.device.position) <= 0.0005);
    CHECK(forceOf(rig.ticks(5)) == 0.0);
    rig.show(wallSet(10)); // what comes back is felt again
    rig.sceneAges = false;
    rig.hand.position.z -= 0.004;
    CHECK(forceOf(rig.ticks(100)) == doctest::Approx(4.0).epsilon(0.1));
    CHECK(rig.gap() >= 0.0);
}

TEST_CASE("A hand that leaves a region within one late tick, as new data arrives, keeps its place") {
    for (const double back : {0.006, 0.015, 0.03}) {
        auto rig = pressedRig();
        const StepRecord held = rig.step();
        REQUIRE(forceOf(held) == doctest::Approx(5.0).epsilon(0.01));
        rig.hand.position.z += back;
        rig.show(wallSet(9));
        rig.sceneAges = false;
        StepRecord record = rig.step();
        record = rig.ticks(1000);
        CHECK(record.vanished == 0);
        CHECK(glm::length(record.indexShift) == 0.0);
        CHECK(record.device.position.z == doctest::Approx(held.device.position.z + back));
        rig.hand.position.z -= back;
        CHECK(forceOf(rig.ticks(1000)) == doctest::Approx(forceOf(held)).epsilon(0.01));
    }
}

TEST_CASE(
    "A device that is gone renders nothing, is re-indexed where it returns, and its force returns by the "
    "limit") {
    Scene scene = handScene();
    scene.hand.clutchBit = 0;
    auto rig = pressedRig(scene);
    const StepRecord held = rig.step();
    rig.present = false;
    StepRecord record = rig.step();
    CHECK(forceOf(record) == 0.0); // recorded as delivered
    rig.hand.position.x += 0.3;
    rig.ticks(14);
    rig.present = true;
    record = rig.step();
    CHECK(glm::distance(record.device.position, held.device.position) <= 1e-12);
    CHECK(glm::distance(record.tool.position, held.tool.position) <= 1e-6);
    CHECK(forceOf(record) <= 20.0 * 0.001 / rig.options.softStartTime + 1e-9);
    CHECK(forceOf(rig.ticks(100)) == doctest::Approx(forceOf(held)).epsilon(0.01));
}

TEST_CASE("Three losses of the device within a second keep the forces off until a second is clean") {
    auto rig = pressedRig();
    for (int i = 0; i < 3; ++i) {
        rig.present = false;
        rig.ticks(2);
        rig.present = true;
        rig.ticks(100);
    }
    CHECK(forceOf(rig.ticks(850)) == 0.0);
    CHECK(forceOf(rig.ticks(300)) > 4.0);
}

TEST_CASE("A scene lowers the limits and the stiffness of its device, and never raises them") {
    Scene scene = handScene("touch");
    scene.haptics.forceLimit = 1000.0;
    scene.haptics.torqueLimit = 100.0;
    scene.haptics.stiffness = 1e5;
    const HapticOptions high = makeHapticOptions(scene, ballTool());
    CHECK(high.forceLimit == 3.3);
    CHECK(high.torqueLimit == 0.2);
    CHECK(high.springs.stiffness == 400.0);
    CHECK(hapticNotes(scene).size() == 3);
    scene.haptics = handScene("touch").haptics;
    scene.haptics.forceLimit = 0.0;
    CHECK(hapticNotes(scene) == std::vector<std::string>{kNoForce});
    scene.haptics.forceLimit = 1.0;
    scene.haptics.stiffness = 100.0;
    const HapticOptions low = makeHapticOptions(scene, ballTool());
    CHECK(low.forceLimit == 1.0);
    CHECK(low.springs.stiffness == 100.0);
    scene = handScene();
    scene.haptics.stiffness = 900.0;
    const auto notes = hapticNotes(scene);
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find("900 N/m at the hand, over the passive bound of 800 N/m") != std::string::npos);
}

TEST_CASE("Settings that cannot follow a hand are named with the speed that they reach") {
    Scene scene = handScene();
    CHECK(hapticNotes(scene).empty());
    scene.contact.reach = 1e-4;
    scene.haptics.stepCap = 1e-5;
    scene.haptics.solves = 1;
    const auto notes = hapticNotes(scene);
    REQUIRE(notes.size() == 2);
    CHECK(notes[0].find("up to 0.01 m/s") != std::string::npos);
    CHECK(notes[1].find("up to 0.1 m/s") != std::string::npos);
}

TEST_CASE("A rotational stiffness beyond what the solvers can use is named with the one that is used") {
    Scene scene = handScene();
    scene.haptics.stiffness = 0.1;
    scene.haptics.rotationalStiffness = 15.0;
    const auto notes = hapticNotes(scene);
    REQUIRE(notes.size() == 2); // the first is on a stiffness that no hand feels
    CHECK(notes[1] ==
          "haptics.rotational_stiffness: 15 N m/rad asked, 10 N m/rad used: with a stiffness of 0.1 "
          "N/m, from 1e-08 to 100 times that are possible");
    scene.haptics.rotationalStiffness = 9.0;
    CHECK(hapticNotes(scene).size() == 1);
}

TEST_CASE("A coarse hand map, late answers and a fast slew limit are named with what they do") {
    Scene scene = handScene();
    scene.hand.scale = 50.0; // 8 and 10 m/s of the tool are less of the hand
    auto notes = hapticNotes(scene);
    REQUIRE(notes.size() == 2);
    CHECK(notes[0].find("/ hand.map.scale: the tool follows a hand up to 0.16 m/s") != std::string::npos);
    CHECK(notes[1].find("up to 0.2 m/s") != std::string::npos);
    scene.hand.scale = 1.0;
    scene.contact.delay = 100;
    notes = hapticNotes(scene);
    REQUIRE(notes.size() == 2);
    CHECK(notes[0].find("/ contact.delay: the tool follows a hand up to 0.1 m/s") != std::string::npos);
    CHECK(notes[1].find("contact answers are 0.1 s late; forces fade") != std::string::npos);
    scene.contact.delay = 0;
    scene.haptics.slewForce = 1e9;
    notes = hapticNotes(scene);
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find("slew_N_per_s: 1e+09 N/s, over the default of 2000") != std::string::npos);
}
