// SPDX-License-Identifier: Apache-2.0
#include "devices/skipped_frames.h"

#include "engine/types/error.h"
#include "tests/realtime/listening.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("Skipped frames are counted, and each cause is logged once, up to a limit") {
    SkippedFrames skipped;
    const testing::Listening log;
    for (int i = 0; i < 90; ++i) {
        skipped.add("camera", "damaged");
    }
    skipped.add("camera", "no colour", 3);
    skipped.add("camera", "far pixels", 0);
    CHECK(skipped.count() == 93);
    CHECK(log.count("camera: frame skipped: damaged (logged once)") == 1);
    CHECK(log.count("camera: far pixels (logged once)") == 1); // those frames were used
    CHECK(skipped.causes() == std::vector<std::string>{"damaged", "far pixels", "no colour"});
    for (int i = 0; i < 90; ++i) {
        skipped.add("camera", "short: " + std::to_string(i) + " bytes");
    }
    CHECK(skipped.causes().size() == SkippedFrames::kMaxCauses);
}

TEST_CASE("A camera whose frames are all unusable is lost after the time given, a silent one is not") {
    SkippedFrames skipped;
    const uint32_t before = skipped.count();
    CHECK_NOTHROW(skipped.limit("camera", before, 99.0, 6.0)); // none came
    skipped.add("camera", "damaged");
    skipped.add("camera", "far pixels", 0); // those frames were used
    CHECK_NOTHROW(skipped.limit("camera", before, 5.9, 6.0));
    CHECK_THROWS_WITH_AS(skipped.limit("camera", before, 6.1, 6.0),
                         "camera: frames arrive, but none is usable; last: damaged", DeviceLost);
    CHECK_NOTHROW(skipped.limit("camera", skipped.count(), 6.1, 6.0)); // it was skipped before this wait
}
