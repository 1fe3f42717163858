// SPDX-License-Identifier: Apache-2.0
// How forces fade and return.
#include "engine/haptics/force_ramps.h"

#include <array>
#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("Forces fade out by a factor and return by their limit, from what the device renders") {
    constexpr double kTick = 0.001;
    ForceRamps ramps;
    const auto ticks = [&](int count, std::array<bool, 3> on, double rendered) {
        for (int i = 0; i < count; ++i) {
            ramps.step(on, kTick, kTick, rendered, 1.5);
        }
    };
    ticks(150, {true, true, true}, 0.0); // first time: 1.5 s
    CHECK(ramps.limitScale() == doctest::Approx(0.1));
    CHECK(ramps.fadeGain() == 1.0);
    ticks(1400, {true, true, true}, 0.5);
    CHECK(ramps.limitScale() == 1.0);
    ticks(100, {true, false, true}, 0.5); // trapped: half of 0.2 s
    CHECK(ramps.fadeGain() == doctest::Approx(0.5));
    ticks(1, {true, true, true}, 0.3); // the limit starts where the device is
    CHECK(ramps.fadeGain() == 1.0);
    CHECK(ramps.limitScale() == doctest::Approx(0.3 + 0.005));
    ramps.cut();
    CHECK(ramps.off());
    ticks(1, {true, true, true}, 0.0);
    CHECK(ramps.limitScale() == doctest::Approx(kTick / 1.5));
}
