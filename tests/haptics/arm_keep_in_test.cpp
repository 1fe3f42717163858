// SPDX-License-Identifier: Apache-2.0
// Which spheres of an arm the shapes and regions hold: not those that no joint moves, and in a keep_in shape
// only those that are inside when it is placed.
#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

Shape boxAt(const dvec3& at, const dvec3& size, bool keepIn) {
    Shape shape;
    shape.kind = ShapeKind::Box;
    shape.baseTshape.position = at;
    shape.size = size;
    shape.keepIn = keepIn;
    return shape;
}

constexpr double kBaseBall = 0.05; // [m]

// Slew, shoulder and elbow with two links of 0.3 m; balls on the base, in the middle of the links and at the
// tip.
ArmModel armWithBase() {
    ArmModel arm;
    for (int k = 0; k < 3; ++k) {
        ArmJoint joint;
        joint.name = std::to_string(k);
        joint.before.position = k == 2 ? dvec3(0.3, 0.0, 0.0) : dvec3(0.0);
        joint.axis = k == 0 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
        joint.lower = -2.0;
        joint.upper = 2.5;
        joint.speed = 2.0;
        arm.joints.push_back(joint);
    }
    arm.links = {"base", "upper", "fore", "tip"};
    arm.leaves = {{{dvec3(0.0), kBaseBall}, 0, 0},
                  {{{0.15, 0.0, 0.0}, 0.02}, 2, 1},
                  {{{0.15, 0.0, 0.0}, 0.02}, 3, 2},
                  {{{0.3, 0.0, 0.0}, 0.02}, 3, 3}};
    arm.lastTtip.position = {0.3, 0.0, 0.0};
    return arm;
}

const JointVector kBent{0.0, -0.6, 1.2};

struct Moved {
    size_t contact = 0, escape = 0;
    double residual = 0.0;
    double minGap = 1.0; // [m] smallest that a step reports
};

// Moves the hand by `by` from the tip within 300 ticks, then holds it for 300.
Moved move(ArmProxy& proxy, const dvec3& by, const ContactSet* set = nullptr) {
    const Pose from = proxy.tip();
    Moved moved;
    for (int i = 1; i <= 600; ++i) {
        Pose target = from;
        target.position += std::min(1.0, i / 300.0) * by;
        const ArmStep step = proxy.step(target, 0.0, set);
        moved.contact += step.contact ? 1 : 0;
        moved.escape += step.escape ? 1 : 0;
        moved.residual = step.residual;
        moved.minGap = std::min(moved.minGap, step.minGap);
    }
    return moved;
}

} // namespace

TEST_CASE("A keep_in shape around the tip does not pull in links that are outside of it at the start") {
    const ArmModel arm = armWithBase();
    const std::vector<Shape> shapes{boxAt({0.495, 0.0, 0.0}, {0.3, 0.5, 0.3}, true)};
    ArmProxy proxy(arm, Pose{}, {}, kBent, shapes);
    const Moved inside = move(proxy, {0.03, 0.05, 0.03});
    CHECK(inside.contact == 0);
    CHECK(inside.escape == 0);
    CHECK(inside.residual < 1e-6);
    const Moved beyond = move(proxy, {0.0, 0.0, 0.3});
    CHECK(beyond.contact > 100);
    CHECK(beyond.escape == 0);
    CHECK(proxy.tip().position.z < 0.15 - 0.02 + 1e-9); // the tip stays inside
}

TEST_CASE("A keep_in shape that moves still holds what was inside, and takes in what comes inside") {
    const ArmModel arm = armWithBase();
    const dvec3 size(0.3, 0.5, 0.3);
    ArmProxy proxy(arm, Pose{}, {}, kBent, std::vector{boxAt({0.495, 0.0, 0.0}, size, true)});
    proxy.setShapes(std::vector{boxAt({0.495, 0.0, 0.15}, size, true)}); // half of the tip is outside
    const Moved pushed = move(proxy, {0.0, 0.0, 0.0});
    CHECK(pushed.escape > 5);
    CHECK(pushed.contact > 100);
    CHECK(proxy.tip().position.z > 0.02 - 1e-6);

    ArmProxy outside(arm, Pose{}, {}, kBent, std::vector{boxAt({0.495, 0.0, 0.5}, size, true)});
    CHECK(move(outside, {0.0, 0.0, 0.05}).contact == 0); // it holds nothing
    outside.setShapes(std::vector{boxAt({0.495, 0.0, 0.0}, size, true)});
    move(outside, {0.0, 0.0, 0.3});
    CHECK(outside.tip().position.z < 0.15 - 0.02 + 1e-9);
}

TEST_CASE(
    "A keep_in shape takes over nothing from one that was removed before it, nor from a former posture") {
    const ArmModel arm = armWithBase();
    const Shape room = boxAt({0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}, true);
    Shape cell = boxAt({0.495, 0.0, 0.0}, {0.2, 0.4, 0.3}, true);
    cell.fixture = 1;
    ArmProxy proxy(arm, Pose{}, {}, kBent, std::vector{room, cell});
    cell.fixture = 0; // as in a scene without the room
    proxy.setShapes(std::vector{cell});
    CHECK(move(proxy, {0.0, 0.0, 0.0}).contact == 0);

    proxy.setPosture({{0.0, 0.0, 0.0}, 0.0}); // stretched: other leaves are in the cell
    proxy.setPosture({kBent, 0.0});
    CHECK(move(proxy, {0.0, 0.0, 0.0}).contact == 0);
}

TEST_CASE("A keep_in wall still holds a real arm that was measured up to 20 mm beyond it") {
    const ArmModel arm = armWithBase();
    ArmProxy proxy(arm, Pose{}, {}, kBent, std::vector{boxAt({0.495, 0.0, 0.0}, {0.3, 0.4, 0.3}, true)});
    REQUIRE(move(proxy, {0.0, 0.3, 0.0}).contact > 100);
    REQUIRE(proxy.tip().position.y == doctest::Approx(0.18).epsilon(1e-3));
    ArmPosture measured = proxy.posture();
    measured.q[0] += 0.02; // 10 mm
    proxy.setPosture(measured);
    move(proxy, {0.0, 0.1, 0.0});
    CHECK(proxy.tip().position.y < 0.18 + 0.011);
    measured.q[0] += 0.2; // 0.1 m: the arm is somewhere else
    proxy.setPosture(measured);
    CHECK(move(proxy, {0.0, 0.05, 0.0}).contact == 0);
}

TEST_CASE("A base inside a forbidden shape never escapes, and the tip still feels the other shapes") {
    const ArmModel arm = armWithBase();
    const std::vector<Shape> shapes{boxAt({0.0, 0.0, -0.05}, {0.2, 0.2, 0.1}, false),
                                    boxAt({0.5, 0.0, -0.2}, {0.3, 0.3, 0.2}, false)};
    ArmProxy proxy(arm, Pose{}, {}, kBent, shapes);
    const Moved moved = move(proxy, {0.0, 0.0, -0.2});
    CHECK(moved.escape == 0);
    CHECK(moved.contact > 100);
    CHECK(proxy.tip().position.z > -0.1 + 0.02 - 1e-9);
}

TEST_CASE("A link behind locked joints that is inside a shape never escapes") {
    ArmModel arm = armWithBase();
    arm.joints[0].lower = arm.joints[0].upper = 0.0;
    arm.joints[1].lower = arm.joints[1].upper = -0.6;
    const std::vector<Shape> shapes{boxAt({0.1, 0.0, 0.1}, {0.2, 0.2, 0.1}, false)};
    ArmProxy proxy(arm, Pose{}, {}, kBent, shapes);
    const Moved moved = move(proxy, {-0.05, 0.0, 0.0});
    CHECK(moved.escape == 0);
    CHECK(moved.contact == 0);
}

TEST_CASE("A sphere on the axes of all joints that carry it, as on a shoulder, never escapes") {
    ArmModel arm = armWithBase();
    arm.leaves[0].joint = 2; // slew and shoulder meet in its centre
    const std::vector<Shape> shapes{boxAt({0.0, 0.0, -0.05}, {0.2, 0.2, 0.1}, false)};
    ArmProxy proxy(arm, Pose{}, {}, kBent, shapes);
    CHECK(move(proxy, {-0.05, 0.05, 0.0}).escape == 0);
}

TEST_CASE("A base inside a region of points neither escapes nor counts as the smallest gap") {
    const ArmModel arm = armWithBase();
    ArmProxy proxy(arm, Pose{}, {}, kBent);
    World world;
    world.fixtures.spheres.add({0.03, 0.0, 0.0}, 0.03);
    world.fixtures.spheres.add({0.5, 0.0, -0.1}, 0.03);
    world.grid.build(world.fixtures.spheres);
    size_t contact = 0, escape = 0;
    double smallest = 1.0;
    const Pose from = proxy.tip();
    for (int i = 0; i < 400; ++i) {
        world.query(arm, proxy);
        world.set.behind.push_back({0, {0.0, 0.0, 1.0}, 0.05}); // as the query finds for the base
        Pose target = from;
        target.position += std::min(1.0, i / 200.0) * dvec3(0.0, 0.0, -0.1);
        const ArmStep step = proxy.step(target, 0.0, &world.set);
        contact += step.contact ? 1 : 0;
        escape += step.escape ? 1 : 0;
        smallest = std::min(smallest, step.minGap);
    }
    CHECK(escape == 0);
    CHECK(contact > 100);
    CHECK(smallest > -1e-9);
}
