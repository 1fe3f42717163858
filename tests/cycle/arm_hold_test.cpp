// SPDX-License-Identifier: Apache-2.0
// When an arm that was held may follow the tool again.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("After forces were off an arm stays held until the hand meets the tool, and then follows") {
    HapticRig rig = pressedRig();
    CHECK_FALSE(rig.step().armHold);
    rig.hand = at(0, 0, -0.05);
    CHECK_FALSE(rig.ticks(100).armHold); // pressing deep is nothing wrong
    rig.forcesOff = true;
    CHECK(rig.ticks(300).armHold);
    rig.forcesOff = false;
    CHECK(rig.ticks(300).armHold); // the hand is still 60 mm away
    rig.hand = at(0, 0, 0.0095);
    CHECK_FALSE(rig.ticks(50).armHold);
    rig.hand = at(0, 0, -0.05);
    CHECK_FALSE(rig.ticks(100).armHold);
}
