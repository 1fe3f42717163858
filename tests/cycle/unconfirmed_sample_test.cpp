// SPDX-License-Identifier: Apache-2.0
// What the cycle does with samples that no hand can make.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

StepRecord stepOf(HapticRig& rig, bool unconfirmed, bool reindex) {
    rig.change = [=](StepInput& input) {
        input.unconfirmed = unconfirmed;
        input.reindex = reindex;
    };
    return rig.step();
}

} // namespace

TEST_CASE(
    "An unconfirmed sample moves neither hand nor tool, and lets no force rise, also not with a new frame") {
    HapticRig rig = pressedRig();
    const StepRecord before = stepOf(rig, false, false);
    REQUIRE(forceOf(before) == doctest::Approx(5.0).epsilon(0.01));
    rig.hand = at(0.3, 0, -0.3);
    HostFixtures higher = wallSet(2);
    for (float& z : higher.spheres.z) {
        z += 0.003f;
    }
    rig.show(std::move(higher));
    for (int i = 0; i < 4; ++i) {
        const StepRecord record = stepOf(rig, true, false);
        CHECK(record.device.position == before.device.position);
        CHECK(forceOf(record) <= forceOf(before) + 1e-9);
    }
}

TEST_CASE("A hand that is re-indexed elsewhere continues from the pose that it commanded") {
    HapticRig rig = pressedRig();
    const StepRecord before = stepOf(rig, false, false);
    rig.hand.position += dvec3(0.3, 0.1, -0.2);
    const StepRecord there = stepOf(rig, false, true);
    CHECK(glm::distance(there.device.position, before.device.position) < 1e-12);
    CHECK(forceOf(there) == doctest::Approx(forceOf(before)).epsilon(1e-6));
    rig.hand.position.z += 0.001;
    CHECK(stepOf(rig, false, false).device.position.z == doctest::Approx(before.device.position.z + 0.001));
}
