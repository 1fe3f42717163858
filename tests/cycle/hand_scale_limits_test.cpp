// SPDX-License-Identifier: Apache-2.0
// Limits with a scale of the hand map: the hand feels scale times the stiffness and 1 / scale of the torque.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("With a fine hand map the torque at the hand and its slew stay within the limits of the device") {
    for (const double scale : {0.25, 1.0, 4.0}) {
        Scene scene = handScene("sigma"); // 0.2 N m
        scene.hand.scale = scale;
        const HapticOptions options = makeHapticOptions(scene, ballTool());
        CHECK(options.torqueLimit / scale <= 0.2 + 1e-12);
        CHECK(options.torqueLimit == doctest::Approx(0.2 * std::min(1.0, scale)));
        CHECK(options.slewTorque == doctest::Approx(scene.haptics.slewTorque * std::min(1.0, scale)));
        CHECK(options.forceLimit == 12.0);
    }
}

TEST_CASE("A stiffness of the scene is bounded by what the device renders at the hand") {
    for (const double scale : {0.5, 2.0}) {
        Scene scene = handScene("touch"); // 400 N/m
        scene.hand.scale = scale;
        scene.haptics.stiffness = 5000.0;
        CHECK(makeHapticOptions(scene, ballTool()).springs.stiffness == doctest::Approx(400.0 / scale));
    }
}
