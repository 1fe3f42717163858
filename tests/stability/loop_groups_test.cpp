// SPDX-License-Identifier: Apache-2.0
// The groups of coupling, rotation, guidance, precision and the long run: every case of `fathom stability` in
// short.
#include "tests/stability/group_check.h"
#include "tests/support/sanitized.h"
#include "tests/support/vulkan.h"

using namespace fathom;
using namespace fathom::stability;
using namespace fathom::testing;

TEST_CASE(
    "Every case of group stiff holds: no closed loop draws energy and the boundary is where theory puts it") {
    checkGroup(stiffCases(), Group::Stiff, 3);
}

TEST_CASE("Every case of group rotation holds: angles near 180 degrees, dead axes, devices without torque") {
    checkGroup(rotationCases(), Group::Rotation, 3);
}

TEST_CASE("Every case of group guidance holds: far, flickering, collinear, flat and single-point targets") {
    checkGroup(guidanceCases(), Group::Guidance, 3);
}

TEST_CASE("Every case of group precision holds: float32 shaders against their float64 twins") {
    checkGroup(precisionCases([]() -> gpu::Device& { return test::vulkan().device; }), Group::Precision, 3);
}

// Not under a sanitizer, which keeps what is freed: memory grows by that.
TEST_CASE("Every case of group long-run holds: no drift, no growth of memory, the same digest" *
          doctest::skip(kSanitized)) {
    checkGroup(longRunCases(), Group::LongRun, 1);
}
