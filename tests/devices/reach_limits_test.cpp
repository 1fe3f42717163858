// SPDX-License-Identifier: Apache-2.0
// The limits that a Reach arm's driver puts on what it sends.
#include "devices/serial/reach_arm.h"
#include "tests/devices/driver_rig.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct LimitRig : DriverRig<ReachSimulator, ReachArm> {
    LimitRig()
        : DriverRig(0.01, ReachSimulator{}, ReachOptions{}, ReachKind::Alpha5) {}
};

} // namespace

TEST_CASE("When the line is cut, the jaws of a Reach arm move on by at most 5 mm") {
    LimitRig rig;
    rig.run(0.5, {{0.0, 0.0, 0.0, 0.0, 0.1}, false}); // 100 mm
    const double there = rig.arm.position[1];         // [mm]
    REQUIRE(there > 5.0);
    rig.line.faults.cut = true;
    rig.run(10.0, {{0.0, 0.0, 0.0, 0.0, 0.1}, false});
    CHECK(rig.arm.position[1] - there <= 5.0);
}

TEST_CASE("A motor of a Reach arm that is overloaded in the negative direction holds the arm, too") {
    LimitRig rig;
    rig.run(0.2, {});
    rig.arm.current[3] = -2000.0; // [mA] of 1500
    rig.run(0.5, {});
    CHECK(rig.driver.feedback().overloaded);
    CHECK(rig.driver.feedback().holding);
}

TEST_CASE("An axis of a Reach arm whose setpoint is not a number stands still, and the others follow") {
    LimitRig rig;
    const ArmCommand go{{0.3, -0.2, 0.4, 0.1, 0.01}, false};
    rig.run(2.0, go);
    ArmCommand broken{{0.1, std::nan(""), 0.1, 0.1, 0.01}, false};
    rig.run(2.0, broken);
    CHECK(rig.arm.position[5] == doctest::Approx(0.1).epsilon(1e-3));
    CHECK(rig.arm.position[4] == doctest::Approx(-0.2).epsilon(1e-3));
    CHECK(rig.arm.position[3] == doctest::Approx(0.1).epsilon(1e-3));
}
