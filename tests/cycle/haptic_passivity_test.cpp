// SPDX-License-Identifier: Apache-2.0
// The passivity controller in the haptic step.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace fathom;
using namespace fathom::testing;

namespace {

// The hand at rest 3 mm inside the wall.
HapticRig restingRig(bool controller) {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    rig.options.passivityController = controller;
    rig.restart();
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    rig.hand = at(0, 0, 0.0072);
    rig.ticks(50);
    return rig;
}

HostFixtures raisedWall(double height = 0.002) { // [m]
    HostFixtures fixtures = wallSet(2);
    fixtures.origin.z = height;
    return fixtures;
}

} // namespace

TEST_CASE("On a static wall the wrench is the same with and without the passivity controller") {
    HapticRig with(handScene(), at(0, 0, 0.02)), without(handScene(), at(0, 0, 0.02));
    CHECK(with.options.passivityController); // the default
    without.options.passivityController = false;
    without.restart();
    for (HapticRig* rig : {&with, &without}) {
        rig->show(wallSet());
        rig->sceneAges = false;
    }
    double largest = 0.0;
    for (int i = 0; i < 1500; ++i) {
        const double s = 0.004 * i;
        with.hand =
            without.hand = {{0.02 * std::sin(s), 0.01 * std::cos(1.3 * s), 0.008 + 0.012 * std::cos(2.1 * s)},
                            rotationExp({0.3 * std::sin(s), 0.0, s})};
        const auto a = with.step(), b = without.step();
        REQUIRE(a.wrench.force == b.wrench.force);
        REQUIRE(a.wrench.torque == b.wrench.torque);
        largest = std::max(largest, glm::length(a.wrench.force));
    }
    CHECK(largest > 5.0);
    CHECK(with.cycle->passivity().dissipated() == 0.0);
}

TEST_CASE(
    "A hand that touches a static wall feels stiffness and damping, and never more, however soft both are") {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    rig.options.springs.stiffness = 3.0;
    rig.options.springs.damping = 0.4;
    rig.restart();
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    double pressed = 0.0;
    for (int i = 0; i < 200; ++i) {
        rig.hand.position.z -= 1e-4; // 0.1 m/s
        const StepRecord record = rig.step();
        pressed = std::max(0.0, record.tool.position.z - rig.hand.position.z);
        REQUIRE(record.wrench.force.z <= 3.0 * pressed + 0.4 * 0.1 + 1e-6);
    }
    CHECK(pressed > 0.009);
    CHECK(rig.cycle->passivity().dissipated() == 0.0);
}

TEST_CASE(
    "A wall that jumps is counted, and the hand is damped within all limits until the energy is paid back") {
    auto rig = restingRig(true), off = restingRig(false);
    const double force = glm::length(rig.step().wrench.force);
    off.step();
    for (HapticRig* r : {&rig, &off}) {
        r->show(raisedWall());
        r->sceneAges = false;
        r->ticks(40); // 1 mm per tick; the reaction rises within a frame
    }
    const double p = force / 1000.0;
    CHECK(rig.cycle->passivity().generated() == doctest::Approx(1000.0 * (p * 0.002 + 2e-6)).epsilon(0.01));
    CHECK(off.cycle->passivity().generated() == 0.0);
    dvec3 before = rig.step().wrench.force;
    off.step();
    double weaker = 0.0;
    for (int i = 0; i < 60; ++i) { // the hand yields at 30 mm/s
        rig.hand.position.z += 3e-5;
        off.hand.position.z += 3e-5;
        const auto a = rig.step(), b = off.step();
        CHECK(a.tool.position == b.tool.position); // damping does not affect the tool
        CHECK(a.wrench.force.z <= b.wrench.force.z + 1e-12);
        CHECK(glm::distance(a.wrench.force, before) <= 2.0 * (1.0 + 1e-12));
        before = a.wrench.force;
        weaker = std::max(weaker, b.wrench.force.z - a.wrench.force.z);
    }
    CHECK(weaker > 0.3); // the debt over 33 ms, at most 20 N s/m at 0.03 m/s; more while the springs push out
    CHECK(weaker <= PassivityController::kMaxRelease / 0.001 * 0.03 * 1.01);
    CHECK(rig.cycle->passivity().dissipated() > 0.0);
}

TEST_CASE("A hand that pushes on after a small jump of the wall is not braked by more than 20 N s/m") {
    auto rig = restingRig(true), off = restingRig(false);
    for (HapticRig* r : {&rig, &off}) {
        r->show(raisedWall(0.0001)); // a small part of the stored energy
        r->sceneAges = false;
        r->ticks(40);
    }
    CHECK(rig.cycle->passivity().debt() > 0.0);
    double stronger = 0.0;
    for (int i = 0; i < 60; ++i) {
        rig.hand.position.z -= 3e-5; // 30 mm/s
        off.hand.position.z -= 3e-5;
        stronger = std::max(stronger, std::abs(forceOf(rig.step()) - forceOf(off.step())));
    }
    CHECK(stronger <= 20.0 * 0.03 * 1.01);
}

TEST_CASE("With forces off the wrench stays zero, and an old energy debt is forgotten") {
    auto rig = restingRig(true);
    rig.show(raisedWall(0.008)); // more than is felt slowly, as noise is
    rig.sceneAges = false;
    rig.ticks(40);
    REQUIRE(rig.cycle->passivity().debt() > 0.005);
    rig.forcesOff = true;
    rig.ticks(220);
    for (int i = 0; i < 50; ++i) {
        rig.hand.position.x += 1e-4;
        CHECK(glm::length(rig.step().wrench.force) == 0.0);
    }
    CHECK(rig.cycle->passivity().debt() == 0.0);
}

TEST_CASE("After contact the damping is below 1 N and ends within 90 ms, also while the hand turns") {
    HapticRig rig(handScene("omega"), at(0, 0, 0.02));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(300);
    for (int i = 0; i < 300; ++i) { // 12 mm into the wall
        rig.hand.position.z -= 0.022 / 300.0;
        rig.step();
    }
    rig.forcesOff = true;
    rig.ticks(300);
    rig.forcesOff = false; // the force that returns is energy that the hand did not give
    rig.ticks(2000);
    int free = 0;
    double braked = 0.0;
    for (int i = 0; i < 500; ++i) {
        rig.hand.position.z += 0.00015;
        const double turn = 0.6 * std::sin(0.004 * i);
        rig.hand.rotation = rotationExp({turn, 0.7 * turn, 0.3 * turn});
        const StepRecord record = rig.step();
        free += record.contactCount == 0 ? 1 : 0;
        if (free > 0) {
            CHECK(forceOf(record) < 1.0);
            CHECK((free < 95 || forceOf(record) == 0.0));
            braked = std::max(braked, forceOf(record));
        }
    }
    CHECK(free > 300);
    CHECK(braked > 0.5);
}

TEST_CASE("While the force of regions that vanished fades, the damping is below 1 N and ends within 90 ms") {
    HapticRig rig = restingRig(true), off = restingRig(false);
    for (HapticRig* r : {&rig, &off}) {
        r->show(raisedWall(0.015)); // energy that the hand did not give
        r->sceneAges = false;
        r->ticks(300);
        r->show(emptySet(3));
        r->sceneAges = false;
    }
    REQUIRE(rig.cycle->passivity().debt() > 0.1);
    double braked = 0.0;
    for (int i = 0; i < 150; ++i) {
        rig.hand.position.z -= 2e-4; // 0.2 m/s against the fading force
        off.hand.position.z -= 2e-4;
        const StepRecord a = rig.step(), b = off.step();
        CHECK(b.wrench.force.z > 3.0);
        const double damping = glm::distance(a.wrench.force, b.wrench.force);
        CHECK(damping < 1.0);
        CHECK((i < 95 || damping < 1e-9));
        braked = std::max(braked, damping);
    }
    CHECK(braked > 0.9);
}

TEST_CASE("A hand that slides on a surface that moved towards it is not braked, nor pulled when it leaves") {
    HapticRig rig = restingRig(true), off = restingRig(false);
    for (HapticRig* r : {&rig, &off}) {
        r->show(raisedWall(0.015));
        r->sceneAges = false;
        r->ticks(300);
    }
    const double owed = rig.cycle->passivity().debt();
    REQUIRE(owed > 0.1);
    for (int i = 0; i < 150; ++i) {
        rig.hand.position.x = off.hand.position.x += 2e-4; // 0.2 m/s
        const StepRecord a = rig.step(), b = off.step();
        // Only where the spring pushes it off a sphere; in all directions it would be 20 N s/m, 4 N.
        CHECK(glm::distance(a.wrench.force, b.wrench.force) < 0.9);
        CHECK(b.wrench.force.z > 15.0);
    }
    CHECK(rig.cycle->passivity().debt() > 0.5 * owed);
    double weaker = 0.0;
    for (int i = 0; i < 170; ++i) { // out at 0.1 m/s and sideways, in contact to the end
        rig.hand.position += dvec3(1e-4, 0.0, 1e-4);
        off.hand.position += dvec3(1e-4, 0.0, 1e-4);
        const dvec3 with = rig.step().wrench.force, without = off.step().wrench.force;
        CHECK(with.z > -0.1); // weaker, and never a pull
        CHECK(std::abs(with.x - without.x) < 1.0);
        weaker = std::max(weaker, without.z - with.z);
    }
    CHECK(weaker > 5.0);
}

TEST_CASE("A hand that slides on a surface that rises slowly is not braked either") {
    HapticRig rig = restingRig(true), off = restingRig(false);
    for (int i = 0; i < 600; ++i) {
        dvec3 force[2];
        for (HapticRig* r : {&rig, &off}) {
            if (i % 11 == 0) { // 90 Hz, 20 mm/s
                r->show(raisedWall(2e-5 * i));
                r->sceneAges = false;
            }
            r->hand.position.x += 6e-5;
            force[r == &rig ? 0 : 1] = r->step().wrench.force;
        }
        const dvec3 braked = force[0] - force[1];
        CHECK(std::hypot(braked.x, braked.y) < 0.6); // 20 N s/m would be 1.2 N
    }
    CHECK(rig.cycle->passivity().generated() > 0.01);
}

TEST_CASE("Forces that fade in a gap of frames and return do not brake a hand that slides on a wall") {
    for (const int gap : {150, 400, 900}) { // [ms] without a frame
        CAPTURE(gap);
        HapticRig with = restingRig(true), without = restingRig(false);
        double weakest = 10.0;
        for (int i = 0; i < gap + 400; ++i) {
            dvec3 force[2];
            for (HapticRig* rig : {&with, &without}) {
                rig->hand.position.x = 0.02 * std::sin(0.01 * i); // up to 0.2 m/s
                rig->sceneAges = i < gap;
                force[rig == &with ? 0 : 1] = rig->step().wrench.force;
            }
            CHECK(glm::distance(force[0], force[1]) < 0.05);
            weakest = std::min(weakest, glm::length(force[0]));
        }
        CHECK(weakest < (gap == 150 ? 2.9 : gap == 400 ? 1.6 : 1e-9)); // it faded
        CHECK(forceOf(with.step()) > 2.5);                             // and returned
    }
}

TEST_CASE("What a hand presses deeper while forces are faded out is energy that it did not give") {
    HapticRig rig = restingRig(true);
    const double depth = forceOf(rig.step()) / 1000.0; // [m]
    rig.sceneAges = true;
    rig.ticks(800);
    CHECK(rig.cycle->passivity().given() == doctest::Approx(500.0 * depth * depth).epsilon(0.05));
    rig.hand.position.z -= 0.003;
    rig.ticks(50);
    rig.sceneAges = false;
    rig.ticks(250);
    const double deeper = depth + 0.003;
    CHECK(rig.cycle->passivity().given() < 1e-5);
    CHECK(rig.cycle->passivity().debt() ==
          doctest::Approx(500.0 * (deeper * deeper - depth * depth)).epsilon(0.05));
}

TEST_CASE("Guidance work on the hand does not count as generated energy") {
    Scene scene = handScene();
    scene.fixtures.emplace_back();
    scene.fixtures.back().role = Role::Guidance;
    HapticRig rig(scene, at(0, 0, 0.05));
    rig.show(wallSet());
    rig.sceneAges = false;
    GuidancePose target;
    target.present = target.planar = true;
    target.target = at(0, 0, 0.12);
    rig.guidance = {target};
    rig.buttons = kGuidanceButton;
    rig.ticks(900);
    for (int i = 0; i < 500; ++i) { // guidance pulls the hand: 2 N over 50 mm
        rig.hand.position.z += 1e-4;
        const auto record = rig.step();
        CHECK(record.wrench.force.z == doctest::Approx(2.0).epsilon(1e-9));
    }
    CHECK(rig.cycle->passivity().dissipated() == 0.0);
    CHECK(rig.cycle->passivity().generated() <= 1e-9);
}
