// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_kinematics.h"

#include "devices/usb/falcon_drive.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>

using namespace fathom;

namespace {

// Places over the workspace, a ball of 40 mm about home, in steps that are no round part of it.
template <class Visit>
int overWorkspace(Visit&& visit) {
    int count = 0;
    for (double x = -0.04; x <= 0.04; x += 0.0117) {
        for (double y = -0.04; y <= 0.04; y += 0.0117) {
            for (double z = -0.04; z <= 0.04; z += 0.0117) {
                if (glm::length(dvec3(x, y, z)) <= 0.04) {
                    visit(FalconKinematics::kHome + dvec3(x, y, z));
                    ++count;
                }
            }
        }
    }
    return count;
}

FalconState homedAt(const dvec3& knob) {
    FalconState state;
    state.homed = 7;
    const auto angles = FalconKinematics::inverse(knob);
    REQUIRE(angles);
    state.encoder = FalconKinematics::encoderOf(*angles);
    return state;
}

} // namespace

TEST_CASE("With all joints at 35 degrees, encoders zero, the knob is 0.1346 m out on the axis") {
    const LegAngles angles = FalconKinematics::anglesOf({0, 0, 0});
    for (const double angle : angles) {
        CHECK(angle == doctest::Approx(35.0 * kDegree).epsilon(1e-15));
    }
    const auto knob = FalconKinematics::forward(angles, {0.01, -0.01, 0.12});
    REQUIRE(knob);
    CHECK(std::abs(knob->x) < 1e-9);
    CHECK(std::abs(knob->y) < 1e-9);
    CHECK(knob->z == doctest::Approx(0.1346).epsilon(2e-4));
    const auto home = FalconKinematics::inverse(*knob); // the elbow that the device has, not the other one
    CHECK((*home)[1] == doctest::Approx(35.0 * kDegree).epsilon(1e-9));
    CHECK(FalconKinematics::anglesOf({1, 0, 0})[0] - angles[0] ==
          doctest::Approx(0.0364347 * kDegree).epsilon(1e-5));
    CHECK(FalconKinematics::encoderOf(FalconKinematics::anglesOf({-1234, 5, 999})) ==
          std::array<int16_t, 3>{-1234, 5, 999});
}

TEST_CASE("Forward and inverse kinematics undo each other over the whole workspace") {
    double worst = 0.0, worstClosure = 0.0;
    const int places = overWorkspace([&](const dvec3& knob) {
        const auto angles = FalconKinematics::inverse(knob);
        REQUIRE(angles);
        const auto back = FalconKinematics::forward(*angles);
        REQUIRE(back);
        worst = std::max(worst, glm::distance(*back, knob));
        // An independent check of the mechanism: the parallelogram between elbow and knob has length b.
        for (int leg = 0; leg < 3; ++leg) {
            const double phi = (105.0 - 120.0 * leg) * kDegree, t = (*angles)[static_cast<size_t>(leg)];
            const double u = std::cos(phi) * knob.x + std::sin(phi) * knob.y - 0.0400;
            const double v = -std::sin(phi) * knob.x + std::cos(phi) * knob.y + 0.02309;
            const dvec3 span(u + 0.01443 - 0.060 * std::cos(t), v - 0.025, knob.z - 0.060 * std::sin(t));
            const double inPlane = std::hypot(span.x, span.z) - 0.0225;
            worstClosure = std::max(worstClosure, std::abs(std::hypot(inPlane, span.y) - 0.1025));
        }
    });
    CHECK(places > 100);
    CHECK(worst < 1e-9);
    CHECK(worstClosure < 1e-12);
    MESSAGE(places << " places, worst " << worst << " m");
}

TEST_CASE("An unreachable position has no joint angles, and impossible angles have no position") {
    CHECK_FALSE(FalconKinematics::inverse({0.0, 0.0, 0.5}));
    CHECK_FALSE(FalconKinematics::inverse({0.3, 0.0, 0.13}));
    CHECK_FALSE(FalconKinematics::inverse({0.0, std::numeric_limits<double>::quiet_NaN(), 0.13}));
    CHECK_FALSE(FalconKinematics::forward({0.6, std::numeric_limits<double>::quiet_NaN(), 0.6}));
}

TEST_CASE("Joint torques do the same work as the force: tau . dtheta = f . dp") {
    const dvec3 forces[] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {2.0, -3.0, 5.0}};
    double worst = 0.0;
    overWorkspace([&](const dvec3& knob) {
        const auto angles = FalconKinematics::inverse(knob);
        for (const dvec3& force : forces) {
            const auto torques = FalconKinematics::torques(knob, *angles, force);
            REQUIRE(torques);
            for (int axis = 0; axis < 3; ++axis) {
                dvec3 step(0.0);
                step[axis] = 1e-6;
                const auto more = FalconKinematics::inverse(knob + step),
                           less = FalconKinematics::inverse(knob - step);
                double work = 0.0;
                for (size_t i = 0; i < 3; ++i) {
                    work += (*torques)[i] * ((*more)[i] - (*less)[i]);
                }
                worst = std::max(worst, std::abs(work - 2e-6 * force[axis]) / 2e-6);
            }
        }
    });
    CHECK(worst < 1e-5); // [N]
}

TEST_CASE(
    "A homed device gives position and buttons; one that is not homed gives neither position nor force") {
    FalconDrive drive;
    HandSample sample;
    const dvec3 knob(0.012, -0.021, 0.118);
    FalconState state = homedAt(knob);
    CHECK(drive.place(state, sample));
    CHECK(glm::distance(sample.deviceThandle.position, knob) < 1e-4); // a count is about 40 um
    CHECK(sample.deviceThandle.rotation == dquat(1.0, 0.0, 0.0, 0.0));
    CHECK(sample.buttons == 0);
    CHECK(drive.motors({0.0, 0.0, 2.0}) != std::array<int16_t, 3>{});

    for (const auto& [device, engine] :
         {std::pair<uint8_t, uint32_t>{4, 1}, {8, 2}, {2, 4}, {1, 0}, {15, 7}}) {
        state.buttons = device;
        drive.place(state, sample);
        CHECK(sample.buttons == engine);
    }
    state.encoder = {0, 0, 0};
    state.homed = 5;
    CHECK_FALSE(drive.place(state, sample));
    CHECK(glm::distance(sample.deviceThandle.position, knob) < 1e-4);
    CHECK(drive.motors({0.0, 0.0, 2.0}) == std::array<int16_t, 3>{});
    CHECK(FalconDrive().motors({1.0, 0.0, 0.0}) == std::array<int16_t, 3>{});
}

TEST_CASE("Motor commands are torques times -10000, scaled together at the motor's limit of 4096") {
    FalconDrive drive;
    HandSample sample;
    drive.place(homedAt({0.01, 0.02, 0.125}), sample);
    const dvec3 small(0.3, -0.2, 1.0);
    const auto some = drive.motors(small);
    const auto torques = FalconKinematics::torques(
        sample.deviceThandle.position, *FalconKinematics::inverse(sample.deviceThandle.position), small);
    for (size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(some[i] + 10000.0 * (*torques)[i]) < 1.0);
    }
    const auto most = drive.motors(1000.0 * small);
    int largest = 0;
    for (size_t i = 0; i < 3; ++i) {
        largest = std::max(largest, std::abs(static_cast<int>(most[i])));
        // The direction is that of the small force.
        CHECK(most[i] * static_cast<double>(some[0]) ==
              doctest::Approx(most[0] * static_cast<double>(some[i])).epsilon(0.01));
    }
    CHECK(largest == kFalconMotorLimit);
    CHECK(drive.motors({0.0, std::numeric_limits<double>::infinity(), 0.0}) == std::array<int16_t, 3>{});
}
