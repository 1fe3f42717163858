// SPDX-License-Identifier: Apache-2.0
// Limits in arm.csv and in the summary, with postures that violate them.
#include "apps/replay/arm_report.h"

#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// One joint from -1 to 1 rad, and one finger that is open at 0.5, its upper limit.
ArmSetup smallSetup() {
    ArmSetup setup;
    setup.model.joints.push_back({"turn", false, {}, {0.0, 0.0, 1.0}, -1.0, 1.0, 1.0});
    ArmFinger finger;
    finger.name = "jaw";
    finger.joint = 1;
    finger.open = finger.upper = 0.5;
    finger.lower = 0.0;
    setup.model.fingers.push_back(finger);
    setup.model.leaves.push_back({{dvec3(0.0), 0.1}, 1, 0});
    setup.model.links.push_back("link");
    setup.proxy.period = 0.001;
    return setup;
}

double violation(const ArmSetup& setup, double before, double q, double grasp) {
    const ScratchFolder folder;
    ArmReport report(folder.path() / "arm.csv", setup);
    TickRow row;
    row.start.arm.q[0] = before;
    row.record.arm.posture = {{q}, grasp};
    report.add(row);
    return report.summary({}).limitViolation;
}

} // namespace

TEST_CASE("A report of an arm finds joints and fingers beyond their limits, and joints that are too fast") {
    ArmSetup setup = smallSetup();
    CHECK(violation(setup, 1.0, 1.0, 0.0) == 0.0);
    CHECK(violation(setup, 0.0, 0.001, 1.0) == 0.0);
    CHECK(violation(setup, 1.1, 1.1, 0.0) == doctest::Approx(0.1));
    CHECK(violation(setup, -1.25, -1.25, 0.0) == doctest::Approx(0.25));
    CHECK(violation(setup, 0.0, 0.003, 0.0) == doctest::Approx(0.002));
    setup.model.fingers[0].open = 0.7;
    CHECK(violation(setup, 0.0, 0.0, 0.0) == doctest::Approx(0.2));
    CHECK(violation(setup, 0.0, 0.0, 1.0) == 0.0);
    setup.model.fingers[0].closed = -0.1;
    CHECK(violation(setup, 0.0, 0.0, 1.0) == doctest::Approx(0.1));
}
