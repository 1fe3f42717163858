// SPDX-License-Identifier: Apache-2.0
// A tool that lags behind the hand for long takes the hand map with it.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("The hand map moves towards a tool that lags, until the hand and the tool are together") {
    HapticRig rig(handScene(), at(0, 0, 0.05));
    rig.options.proxy.stepCap = 1e-5; // 10 mm/s
    rig.options.proxy.solves = 1;
    rig.restart();
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(300);
    rig.hand.position.x = 0.05;
    double lag = rig.ticks(2).lag;
    REQUIRE(lag > 0.045);
    StepRecord record;
    for (int i = 0; i < 20; ++i) {
        record = rig.ticks(100);
        CHECK(record.lag <= lag);
        lag = record.lag;
    }
    CHECK(lag < 0.005);
    CHECK(record.device.position.x < 0.045); // less than 20 mm are the tool's own motion
    CHECK(record.indexShift.x < -0.005);
}
