// SPDX-License-Identifier: Apache-2.0
// How long forces take to fade, by the reason and by the time that ticks really took.
#include "engine/haptics/force_ramps.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr double kNominal = 0.001; // [s]

ForceRamps risen() {
    ForceRamps ramps;
    for (int i = 0; i < 1000; ++i) {
        ramps.step({true, true, true}, kNominal, kNominal, 0.0, ForceRamps::kRampTime);
    }
    return ramps;
}

} // namespace

TEST_CASE("An old scene fades forces in half a second, each other reason in 0.2 s") {
    for (const size_t reason : {ForceRamps::SwitchedOff, ForceRamps::Trapped, ForceRamps::Stale}) {
        std::array<bool, ForceRamps::kReasons> on{true, true, true};
        on[reason] = false;
        ForceRamps ramps = risen();
        REQUIRE(ramps.fadeGain() == 1.0);
        for (int i = 0; i < 100; ++i) {
            ramps.step(on, kNominal, kNominal, 0.5, ForceRamps::kRampTime);
        }
        CHECK(ramps.fadeGain() == doctest::Approx(reason == ForceRamps::Stale ? 0.8 : 0.5));
    }
}

TEST_CASE("A late tick fades forces by the time that it took, and lets them rise by one tick only") {
    ForceRamps ramps = risen();
    ramps.step({false, true, true}, kNominal, 0.05, 1.0, ForceRamps::kRampTime);
    CHECK(ramps.fadeGain() == doctest::Approx(0.75));
    ramps.step({false, true, true}, kNominal, 1.0, 0.5, ForceRamps::kRampTime);
    CHECK(ramps.off());
    CHECK(ramps.limitScale() == 0.0);
    ramps.step({true, true, true}, kNominal, 0.05, 0.0, ForceRamps::kRampTime);
    CHECK(ramps.limitScale() == doctest::Approx(kNominal / ForceRamps::kRampTime));
}
