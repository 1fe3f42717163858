// SPDX-License-Identifier: Apache-2.0
// The coupling, rotation, guidance, precision, long-run and feel groups: every case of `fathom stability` in
// its short form.
#include "tests/stability/group_check.h"
#include "tests/support/sanitized.h"
#include "tests/support/vulkan.h"

using namespace fathom;
using namespace fathom::stability;
using namespace fathom::testing;

TEST_CASE(
    "Every case of group stiff holds: no closed loop generates energy, and the boundary matches theory") {
    checkGroup(stiffCases(), Group::Stiff, 3);
}

TEST_CASE(
    "Every case of group rotation holds: angles near 180 degrees, inactive axes, devices without torque") {
    checkGroup(rotationCases(), Group::Rotation, 3);
}

TEST_CASE(
    "Every case of group guidance holds: distant, flickering, collinear, flat and single-point targets") {
    checkGroup(guidanceCases(), Group::Guidance, 3);
}

TEST_CASE("Every case of group precision holds: float32 shaders against their float64 twins") {
    checkGroup(precisionCases([]() -> gpu::Device& { return testing::vulkan().device; }), Group::Precision,
               3);
}

// Skipped under a sanitizer, because it keeps freed memory, which counts as growth.
TEST_CASE("Every case of group long-run holds: no drift, no growth of memory, the same digest" *
          doctest::skip(kSanitized)) {
    checkGroup(longRunCases(), Group::LongRun, 1);
}

TEST_CASE(
    "Every case of group feel holds: still, sliding, leaving, turning and yielding hands at noisy and clean "
    "surfaces") {
    checkGroup(feelCases(), Group::Feel, 20);
}
