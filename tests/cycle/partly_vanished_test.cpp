// SPDX-License-Identifier: Apache-2.0
// New data takes some of the regions that press. Friction on the others does not let the tool jump.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace fathom;
using namespace fathom::testing;

namespace {

Shape planeFacing(const dvec3& point, const dvec3& turn) { // its normal is z, turned
    Shape plane;
    plane.kind = ShapeKind::Plane;
    plane.baseTshape = {point, rotationExp(turn)};
    return plane;
}

const Shape kGround = planeFacing({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
const Shape kSide = planeFacing({0.03, 0.0, 0.0}, {0.0, -0.5 * M_PI, 0.0}); // faces -x

// Placed shapes only, with friction.
struct FrictionRig : HapticRig {
    explicit FrictionRig(double friction)
        : HapticRig(Scene{}, at(0.0, 0.0, 0.02)) {
        options.proxy.friction = friction;
        cycle = std::make_unique<HapticCycle>(tool, std::array{kGround, kSide}, options, hand);
        ticks(300);
    }
    StepRecord press(const Pose& to) {
        const dvec3 by = (to.position - hand.position) / 200.0;
        for (int i = 0; i < 200; ++i) {
            hand.position += by;
            step();
        }
        return ticks(1000);
    }
};

} // namespace

TEST_CASE("Friction on a floor does not hide that the wall next to it vanished") {
    for (const double friction : {0.02, 0.1, 0.3}) {
        CAPTURE(friction);
        FrictionRig rig(friction);
        const StepRecord pressed = rig.press(at(0.035, 0.0, 0.0));
        REQUIRE(pressed.wrench.force.x == doctest::Approx(-15.0).epsilon(0.01));
        REQUIRE(pressed.wrench.force.z == doctest::Approx(10.0).epsilon(0.01));
        rig.cycle->setShapes(std::array{kGround});
        StepRecord before = pressed;
        for (int i = 0; i < 199; ++i) {
            const StepRecord record = rig.step();
            CHECK(glm::distance(record.tool.position, before.tool.position) <= 0.0003);
            CHECK(glm::distance(record.wrench.force, before.wrench.force) <= 0.3);
            before = record;
        }
        const StepRecord after = rig.ticks(5);
        CHECK(after.vanished == 1);
        CHECK(std::abs(after.wrench.force.x) <= 0.01);
        CHECK(after.wrench.force.z == doctest::Approx(10.0).epsilon(0.01));
        CHECK(glm::distance(after.tool.position, pressed.tool.position) <= 0.0003);
    }
}

TEST_CASE("A wall that goes back under a hand is followed, not lost, however large friction is") {
    for (const double friction : {0.3, 1.0}) {
        CAPTURE(friction);
        FrictionRig rig(friction);
        rig.press(at(0.035, 0.0, 0.009));
        Shape wall = kSide;
        wall.baseTshape.position.x += 0.008;
        rig.cycle->setShapes(std::array{kGround, wall});
        const StepRecord after = rig.ticks(6000);
        CHECK(after.vanished == 0);
        CHECK(after.wrench.force.x == doctest::Approx(-7.0).epsilon(0.05));
    }
}
