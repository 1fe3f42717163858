// SPDX-License-Identifier: Apache-2.0
// Which target the guidance button chooses.
#include "engine/haptics/guidance.h"

#include <doctest/doctest.h>

#include <array>
#include <limits>

using namespace fathom;

namespace {

GuidancePose presentAt(double x) {
    GuidancePose pose;
    pose.present = pose.planar = true;
    pose.target.position.x = x;
    return pose;
}

} // namespace

TEST_CASE("A target that is not finite is never chosen, even as the first") {
    const std::array poses{presentAt(std::numeric_limits<double>::quiet_NaN()), presentAt(0.3)};
    Guidance guidance;
    guidance.step(poses, {}, true, false, 0.001);
    CHECK(guidance.chosen() == 1);
}

TEST_CASE("A button that was pressed without a target and released changes no fading target later") {
    std::array poses{presentAt(0.2), presentAt(0.1)};
    poses[1].present = false;
    Guidance guidance;
    const auto step = [&](bool button) { guidance.step(poses, {}, button, false, 0.001); };
    for (int i = 0; i < 400; ++i) {
        step(true);
    }
    step(false);
    poses[0].present = false;
    step(true); // finds none
    step(false);
    poses[0].present = poses[1].present = true;
    step(false);
    CHECK(guidance.weight() > 0.5);
    CHECK(guidance.chosen() == 0);
}
