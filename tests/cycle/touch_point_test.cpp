// SPDX-License-Identifier: Apache-2.0
// Where a record says that the tool touches.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A touch is on the leaf's surface, on the side of the region that it touches") {
    HapticRig rig = pressedRig();
    const StepRecord record = rig.step();
    REQUIRE(record.touchCount > 0);
    for (uint32_t i = 0; i < record.touchCount; ++i) {
        const Touch& touch = record.touches[i];
        CHECK(glm::distance(touch.point, record.tool.position - 0.01 * touch.normal) < 1e-5);
        CHECK(touch.point.z < 0.002); // the wall's tops are at 0, the tool's centre at 10 mm
    }
}
