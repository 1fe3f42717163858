// SPDX-License-Identifier: Apache-2.0
// Arms in singular postures whose hand pulls in a direction in which no joint moves the tip.
#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kPi = 3.14159265358979323846;

struct JointAt {
    dvec3 before, axis;
    double limit = 2.5;
};

ArmModel armOf(const std::vector<JointAt>& joints, const dvec3& tip, double speed) {
    ArmModel arm;
    for (const JointAt& at : joints) {
        ArmJoint joint;
        joint.name = std::to_string(arm.joints.size());
        joint.before.position = at.before;
        joint.axis = at.axis;
        joint.lower = -at.limit;
        joint.upper = at.limit;
        joint.speed = speed;
        arm.joints.push_back(joint);
        arm.leaves.push_back({{dvec3(0.0), 0.02}, static_cast<uint32_t>(arm.joints.size()), 0});
    }
    arm.links = {"all"};
    arm.lastTtip.position = tip;
    return arm;
}

// Slew, shoulder and elbow; two links of 0.3 m along x at zero.
ArmModel stretched(double speed = 5.0) {
    return armOf({{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 1, 0}}, {{0.3, 0, 0}, {0, 1, 0}}}, {0.3, 0, 0},
                 speed);
}

// The proportions of a UR5e, straight up at zero.
ArmModel sixJoints() {
    return armOf({{{0, 0, 0.163}, {0, 0, 1}, 6.2},
                  {{0, 0.138, 0}, {0, 1, 0}, 6.2},
                  {{0, -0.131, 0.425}, {0, 1, 0}, 3.1},
                  {{0, 0, 0.392}, {0, 1, 0}, 6.2},
                  {{0, 0.127, 0}, {0, 0, 1}, 6.2},
                  {{0, 0, 0.1}, {0, 1, 0}, 6.2}},
                 {0, 0.1, 0}, kPi);
}

// The proportions of a UR5 whose last axis but one is offset from the neighbouring ones, which are parallel
// where it is at 0.
ArmModel offsetWrist() {
    return armOf({{{0, 0, 0.089}, {0, 0, 1}, 6.2},
                  {{0, 0.136, 0}, {0, 1, 0}, 6.2},
                  {{0, -0.12, 0.425}, {0, 1, 0}, 6.2},
                  {{0, 0, 0.392}, {0, 1, 0}, 6.2},
                  {{0, 0.093, 0}, {0, 0, 1}, 6.2},
                  {{0, 0, 0.0947}, {0, 1, 0}, 6.2}},
                 {0, 0.0823, 0}, kPi);
}

struct Result {
    double residual = 0.0;
    int flips = 0;
    JointVector q{};
};

// Moves the hand from where the tip is by `by` within `seconds`, and turns it by `angle`, then holds it for
// `hold`.
Result pull(ArmProxy& proxy, const dvec3& by, double metricRadius, double seconds, double hold,
            double angle = 0.0, const dvec3& about = {0, 0, 1}) {
    const Pose from = proxy.tip();
    Result result;
    const int moving = static_cast<int>(1000.0 * seconds), all = moving + static_cast<int>(1000.0 * hold);
    for (int i = 1; i <= all; ++i) {
        const double part = std::min(1.0, static_cast<double>(i) / moving);
        const Pose target{from.position + part * by, glm::angleAxis(part * angle, about) * from.rotation};
        const ArmStep step = proxy.step(target, metricRadius, nullptr);
        result.flips += step.flipped ? 1 : 0;
        result.residual = step.residual;
        result.q = step.q;
    }
    return result;
}

} // namespace

TEST_CASE("A stretched arm follows a hand that moves straight inwards, the same way every time") {
    const ArmModel arm = stretched();
    ArmProxy first(arm, Pose{}, {}, {}), second(arm, Pose{}, {}, {});
    const Result result = pull(first, {-0.15, 0, 0}, 0.0, 0.2, 0.5);
    CHECK(result.residual < 1e-6);
    CHECK(result.flips == 0);
    CHECK(std::abs(result.q[2]) > 1.0);
    CHECK(pull(second, {-0.15, 0, 0}, 0.0, 0.2, 0.5).q == result.q);
}

TEST_CASE("An arm that was stretched by the hand bends back to the side that it came from") {
    const ArmModel arm = stretched();
    for (const double side : {1.0, -1.0}) {
        ArmProxy proxy(arm, Pose{}, {}, JointVector{0.0, -0.3 * side, 0.6 * side});
        pull(proxy, {0.2, 0, 0}, 0.0, 0.3, 0.5); // beyond its reach
        CHECK(std::abs(proxy.joints()[2]) < 0.1);
        ArmProxy straight(arm, Pose{}, {}, proxy.joints());
        const Result result = pull(proxy, {-0.2, 0, 0}, 0.0, 0.3, 0.5);
        CHECK(result.residual < 1e-6);
        CHECK(result.flips == 0);
        CHECK(result.q[2] * side > 0.5);
    }
}

TEST_CASE("A joint limit on one side makes the arm bend to the other one") {
    ArmModel arm = stretched();
    arm.joints[2].upper = 0.0;
    ArmProxy proxy(arm, Pose{}, {}, {});
    const Result result = pull(proxy, {-0.15, 0, 0}, 0.0, 0.2, 0.5);
    CHECK(result.residual < 1e-6);
    CHECK(result.q[2] < -1.0);
}

TEST_CASE("Six joints straight up, seven in a line, and four: the tip follows inwards within half a second") {
    const ArmModel six = sixJoints();
    ArmProxy sixProxy(six, Pose{}, {}, {});
    CHECK(pull(sixProxy, {0, 0, -0.1}, 0.1, 0.2, 0.5).residual < 1e-6);

    ArmModel seven = makeArm(7, 1, 2.0);
    for (ArmJoint& joint : seven.joints) {
        joint.speed = 4.0;
    }
    for (const double radius : {0.0, 0.1}) {
        ArmProxy proxy(seven, Pose{}, {}, {});
        CHECK(pull(proxy, {-0.15, 0, 0}, radius, 0.2, 0.5).residual < 1e-6);
    }

    ArmModel four = stretched();
    ArmJoint roll = four.joints[2];
    roll.name = "roll";
    roll.axis = {1, 0, 0};
    four.joints.push_back(roll);
    ArmProxy proxy(four, Pose{}, {}, {});
    CHECK(pull(proxy, {-0.15, 0, 0}, 0.0, 0.2, 0.5).residual < 1e-6);
}

TEST_CASE("A stretched arm that cannot reach its target stays still") {
    const ArmModel arm = stretched();
    ArmProxy proxy(arm, Pose{}, {}, {});
    pull(proxy, {0.1, 0, 0}, 0.0, 0.2, 0.5);
    const JointVector before = proxy.joints();
    const Result result = pull(proxy, {0.1, 0, 0}, 0.0, 0.2, 0.5);
    CHECK(result.residual == doctest::Approx(0.1));
    for (size_t k = 0; k < arm.count(); ++k) {
        CHECK(std::abs(result.q[k] - before[k]) < 1e-6);
    }
}

TEST_CASE(
    "A mimic joint moves with its joint in every step, and the tip follows with what both do together") {
    ArmModel arm = stretched();
    arm.joints[2].mimic = ArmMimic{1, -2.0, 0.4}; // a telescope of two links
    arm.joints[2].lower = -9.0, arm.joints[2].upper = 9.0;
    ArmProxy proxy(arm, Pose{}, {}, JointVector{0.0, 0.3});
    CHECK(proxy.joints()[2] == doctest::Approx(0.4 - 0.6));
    for (int i = 0; i < 1000; ++i) {
        Pose target = proxy.tip();
        target.position = {0.4, 0.05, 0.0};
        const ArmStep step = proxy.step(target, 0.0, nullptr);
        CHECK(std::abs(step.q[2] - (0.4 - 2.0 * step.q[1])) < 1e-12);
    }
    CHECK(proxy.tip().position.x == doctest::Approx(0.4).epsilon(0.02));
    CHECK(proxy.tip().position.y == doctest::Approx(0.05).epsilon(0.02));
}

TEST_CASE("Wrists with and without an offset leave the posture with two parallel axes when the hand turns") {
    ArmProxyOptions options;
    options.period = 0.005; // 0.3 s of pull() are 1.5 s
    const JointVector start{0.0, 0.37, 1.6, kPi - 0.37 - 1.6};
    for (const double offset : {0.0947, 0.0}) {
        ArmModel arm = offsetWrist();
        arm.joints[5].before.position.z = offset;
        for (const double radius : {0.05, 0.0823}) {
            for (const double degrees : {10.0, 25.0, 60.0, 100.0, -60.0}) {
                CAPTURE(offset);
                CAPTURE(radius);
                CAPTURE(degrees);
                ArmProxy proxy(arm, Pose{}, options, start);
                const Result result = pull(proxy, {}, radius, 0.3, 0.4, degrees * kPi / 180.0, {1, 0, 0});
                CHECK(result.residual < 1e-5);
                CHECK(std::abs(result.q[4]) > 0.01);
            }
        }
    }
}
