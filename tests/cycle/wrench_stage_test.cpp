// SPDX-License-Identifier: Apache-2.0
// The last part of a step by itself: shifts of the hand map, causes, and a wrench that turns round.
#include "engine/cycle/wrench_stage.h"

#include "engine/haptics/limits.h"
#include "tests/cycle/haptic_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A stage whose forces are on, for a hand at the origin.
struct Stage {
    HapticOptions options = makeHapticOptions(springsAlone(handScene()), ballTool());
    WrenchInput input;
    std::optional<WrenchStage> stage;

    void start() {
        stage.emplace(options);
        input.springs = options.springs;
        input.forcesOn = true;
        input.pushes = cause::kRow;
        step(3000);
    }
    void step(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            stage->step(input);
        }
    }
    // The hand presses by `length` [m] along `axis`, or turns by 0.1 rad per 10 mm.
    void press(const dvec3& axis, double length, bool turn) {
        input.springEnd = input.device = {turn ? dvec3(0.0) : -length * axis,
                                          turn ? rotationExp(-10.0 * length * axis) : dquat(1, 0, 0, 0)};
    }
    // Along `axis`, as a share of the limit.
    double share(const dvec3& axis, bool turn) {
        const Wrench wrench = stage->step(input).wrench;
        return turn ? glm::dot(wrench.torque, axis) / options.torqueLimit
                    : glm::dot(wrench.force, axis) / options.forceLimit;
    }
};

// From a settled wrench along +x to one that the regions ask for along `axis`.
Stage turnedStage(bool turn, bool filter, const dvec3& axis) {
    Stage hand;
    hand.options.passivityController = false;
    hand.options.springs.rotationalStiffness = 10.0; // [N m/rad]
    hand.options.springs.metricRadius = 0.1;         // [m]
    hand.options.slewForce = filter ? 2000.0 : 5.0;  // [N/s]
    hand.options.slewTorque = filter ? 50.0 : 0.5;   // [N m/s]
    hand.options.lowPassGain = filter ? lowPassGain(0.1, hand.options.period) : 1.0;
    hand.start();
    hand.press({1, 0, 0}, 0.01, turn);
    hand.step(20000);
    hand.press(axis, 0.01, turn);
    return hand;
}

} // namespace

TEST_CASE("What points against the wanted wrench ends within a ramp") {
    for (const bool turn : {false, true}) {
        for (const bool filter : {false, true}) {
            INFO((turn ? "torque, " : "force, ") << (filter ? "low-pass" : "slew limit"));
            Stage hand = turnedStage(turn, filter, {-1, 0, 0});
            double before = hand.share({1, 0, 0}, turn);
            CHECK(before > 0.4);
            for (int tick = 0; tick < 200; ++tick) {
                const double now = hand.share({1, 0, 0}, turn);
                CHECK(now <= before);
                before = now;
            }
            CHECK(before <= 0.0);
            CHECK(before > -0.1); // it rises as slowly as ever
        }
    }
}

TEST_CASE("What lies across the wanted wrench ends within a ramp") {
    for (const bool turn : {false, true}) {
        for (const bool filter : {false, true}) {
            INFO((turn ? "torque, " : "force, ") << (filter ? "low-pass" : "slew limit"));
            Stage hand = turnedStage(turn, filter, {0, 1, 0});
            double most = 0.0;
            for (int tick = 0; tick < 200; ++tick) {
                most = std::max(most, hand.share({1, 0, 0}, turn));
            }
            CHECK(most > 0.4);
            // A low-pass keeps directions calm: 0.2 of the wanted wrench, which is half of the limit.
            CHECK(hand.share({1, 0, 0}, turn) <= (filter ? 0.1 + 1e-3 : 1e-9));
            CHECK(hand.share({0, 1, 0}, turn) > 0.04);
            CHECK(hand.share({0, 1, 0}, turn) < 0.12);
        }
    }
}

TEST_CASE("A torque that its slew limit holds back has that cause, also without a force") {
    Stage hand;
    hand.options.passivityController = false;
    hand.options.slewTorque = 0.1; // [N m/s]
    hand.start();
    CHECK((hand.stage->step(hand.input).cause & cause::kSlew) == 0);
    hand.input.springEnd.rotation = hand.input.device.rotation = rotationExp({0.05, 0, 0});
    const WrenchStage::Output turned = hand.stage->step(hand.input);
    CHECK(turned.wrench.force == dvec3(0.0));
    CHECK(glm::length(turned.wrench.torque) == doctest::Approx(1e-4));
    CHECK((turned.cause & cause::kSlew) != 0);
}

TEST_CASE("The springs' damping does not brake a shift of the hand map") {
    Stage hand;
    hand.options.springs.damping = 0.1;
    hand.start();
    for (int i = 0; i < 100; ++i) {
        hand.input.springEnd.position.z = hand.input.device.position.z = -5e-5 * i;
        hand.stage->step(hand.input);
    }
    const Wrench before = hand.stage->step(hand.input).wrench;
    REQUIRE(before.force.z > 4.0);
    const dvec3 by(0, 0, -0.002);
    hand.stage->shift(by, {1, 0, 0, 0});
    for (Pose* pose : {&hand.input.springEnd, &hand.input.device, &hand.input.allowed}) {
        pose->position += by;
    }
    CHECK(glm::distance(hand.stage->step(hand.input).wrench.force, before.force) < 1e-9);
}

TEST_CASE("A spring that overflows takes the force away in that tick only") {
    Stage hand;
    hand.start();
    hand.press({1, 0, 0}, 0.01, false);
    hand.step(1000);
    const double full = hand.share({1, 0, 0}, false);
    REQUIRE(full > 0.4);
    hand.press({1, 1, 1}, 1e308, false);
    const WrenchStage::Output broken = hand.stage->step(hand.input);
    CHECK_FALSE(broken.finite);
    CHECK(isZero(broken.delivered));
    hand.press({1, 0, 0}, 0.01, false);
    for (int i = 0; i < 1000; ++i) {
        CHECK(hand.stage->step(hand.input).finite);
    }
    CHECK(hand.share({1, 0, 0}, false) == doctest::Approx(full));
}

TEST_CASE("A force that turns while it ramps out is zero when the ramp is, however low the slew limit is") {
    for (const double turns : {5.0, 20.0, 60.0}) { // [rad/s]
        CAPTURE(turns);
        Stage hand;
        hand.options.passivityController = false;
        hand.options.slewForce = 10.0; // [N/s]
        hand.start();
        hand.press({1, 0, 0}, 0.02, false);
        hand.step(20000);
        hand.input.forcesOn = false;
        for (int tick = 0; tick <= 210; ++tick) {
            const double angle = 0.001 * turns * tick;
            hand.press({std::cos(angle), std::sin(angle), 0}, 0.02, false);
            const dvec3 force = hand.stage->step(hand.input).wrench.force;
            CHECK((!hand.stage->off() || force == dvec3(0.0)));
        }
        CHECK(hand.stage->off());
    }
}

TEST_CASE("A torque that ends in a late tick falls in steps of at most the default slew limit") {
    for (const double late : {0.006, 0.03, 0.3}) { // [s]
        CAPTURE(late);
        Stage hand;
        hand.options.passivityController = false;
        hand.options.springs.rotationalStiffness = 10.0; // [N m/rad]
        hand.options.springs.metricRadius = 0.1;         // [m]
        hand.options.slewTorque = 50.0;                  // [N m/s]
        hand.start();
        hand.press({1, 0, 0}, 0.01, true);
        hand.step(1000);
        dvec3 before = hand.stage->step(hand.input).wrench.torque;
        CHECK(glm::length(before) > 0.5);
        hand.press({1, 0, 0}, 0.0, true);
        for (int tick = 0; tick < 40; ++tick) {
            hand.input.elapsed = tick == 3 ? late : hand.options.period;
            const dvec3 torque = hand.stage->step(hand.input).wrench.torque;
            CHECK(glm::distance(torque, before) <= 0.05 * (1.0 + 1e-9));
            before = torque;
        }
        CHECK(before == dvec3(0.0));
    }
}

TEST_CASE(
    "A force that ends in a late tick falls in steps of at most the slew limit, and is off when it is zero") {
    for (const double late : {0.03, 0.3, 1.2}) { // [s]
        for (const char* end : {"off", "stale", "away", "turned", "across"}) {
            const std::string why = end;
            INFO(late << " s, " << why);
            Stage hand;
            hand.options.passivityController = false;
            hand.options.slewForce = 2000.0; // [N/s]
            hand.start();
            hand.press({1, 0, 0}, 0.02, false);
            hand.step(1000);
            dvec3 before = hand.stage->step(hand.input).wrench.force;
            CHECK(glm::length(before) > 8.0);
            const bool across = why == "across"; // while it fades
            hand.input.forcesOn = why != "off" && !across;
            hand.input.stale = why == "stale";
            const dvec3 turned = across ? dvec3(0, 1, 0) : dvec3(-1, 0, 0);
            hand.press(why == "turned" || across ? turned : dvec3(1, 0, 0), why == "away" ? 0.0 : 0.02,
                       false);
            for (int tick = 0; tick < 10; ++tick) {
                hand.input.elapsed = tick == 0 ? late : hand.options.period;
                const dvec3 force = hand.stage->step(hand.input).wrench.force;
                CHECK(glm::distance(force, before) <= 2.0 * (1.0 + 1e-9));
                CHECK((!hand.stage->off() || force == dvec3(0.0)));
                before = force;
            }
            if (late > 1.0 && why != "turned") {
                CHECK(before == dvec3(0.0));
            }
        }
    }
}

TEST_CASE("Ticks that are all late end a force within a ramp, or in the ticks that a fast slew limit needs") {
    for (const double slew : {99.0, 101.0, 300.0, 2000.0}) { // [N/s]
        for (const double late : {0.005, 0.03, 0.3}) {       // [s]
            for (const bool away : {false, true}) {
                INFO(slew << " N/s, " << late << " s, " << away);
                Stage hand;
                hand.options.passivityController = false;
                hand.options.slewForce = slew;
                hand.start();
                hand.press({1, 0, 0}, 0.02, false);
                hand.input.elapsed = late;
                hand.step(1000);
                double share = hand.share({1, 0, 0}, false);
                CHECK(share > 0.4);
                hand.input.forcesOn = away;
                hand.press({1, 0, 0}, away ? 0.0 : 0.02, false);
                const int fewest = slew == 2000.0 ? 10 : 0;
                for (int tick = 0; tick < fewest || tick * late < ForceRamps::kRampTime; ++tick) {
                    share = hand.share({1, 0, 0}, false);
                }
                CHECK(share <= 1e-9);
            }
        }
    }
}

TEST_CASE("A push beyond the limit reaches the limit in every direction") {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 300; ++i) {
        Stage hand;
        hand.options.passivityController = false;
        hand.options.forceLimit = 3.3;
        hand.start();
        hand.press(glm::normalize(dvec3(normal(random), normal(random), normal(random))), 0.02, false);
        hand.step(300);
        const dvec3 force = hand.stage->step(hand.input).wrench.force;
        CHECK(glm::length(force) == doctest::Approx(3.3).epsilon(1e-9));
    }
}

TEST_CASE("Ticks of which every second one is late end a force in time, also at a low slew limit") {
    for (const double late : {0.011, 0.021, 0.101}) { // [s]
        CAPTURE(late);
        Stage hand;
        hand.options.passivityController = false;
        hand.options.forceLimit = 3.3;
        hand.options.slewForce = 20.0; // [N/s], hardly faster than the ramp
        hand.start();
        hand.press({1, 0, 0}, 0.02, false);
        hand.step(1000);
        hand.input.forcesOn = false;
        double time = 0.0; // [s] until there is no force
        for (int tick = 0; !hand.stage->off() && tick < 1000; ++tick) {
            hand.input.elapsed = tick % 2 == 0 ? late : hand.options.period;
            time += hand.input.elapsed;
            hand.stage->step(hand.input);
        }
        CHECK(time <= ForceRamps::kRampTime + late + 0.01);
    }
}
