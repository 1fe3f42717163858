// SPDX-License-Identifier: Apache-2.0
// With a scale of the hand map the springs are bounded by the device's damping at the hand.
#include "engine/haptics/stiffness_watch.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

CouplingOptions scaled(double scale) {
    CouplingOptions options;
    options.handScale = scale;
    return options;
}

} // namespace

TEST_CASE("The damping of the springs takes its share of the device's as the hand feels it") {
    const DevicePreset ideal = devicePreset("ideal"); // 0.5 N s/m
    CouplingOptions options = scaled(2.0);
    options.damping = 0.1;
    CHECK(makeSprings(ideal, options).stiffness == doctest::Approx(2.0 * (0.5 - 0.2) / 0.001 / 2.0));
}

TEST_CASE(
    "A hand scale changes no spring at the planned rate, and slower ticks lower them by as much as without") {
    const DevicePreset ideal = devicePreset("ideal");
    for (const double scale : {0.5, 1.0, 2.0}) {
        CAPTURE(scale);
        CouplingOptions options = scaled(scale);
        options.toolRadius = 0.5; // the bound of the rotation decides
        const Springs planned = makeSprings(ideal, options);
        StiffnessWatch watch(ideal, options, planned);
        for (int i = 0; i < 500; ++i) {
            watch.step(0.001);
        }
        CHECK(watch.springs().stiffness == doctest::Approx(planned.stiffness));
        CHECK(watch.springs().rotationalStiffness == doctest::Approx(planned.rotationalStiffness));
        for (int i = 0; i < 1000; ++i) {
            watch.step(0.002);
        }
        CHECK(watch.springs().stiffness == doctest::Approx(0.5 * planned.stiffness));
        CHECK(watch.springs().rotationalStiffness == doctest::Approx(0.5 * planned.rotationalStiffness));
    }
}
