// SPDX-License-Identifier: Apache-2.0
// Which target the guidance button chooses, and what changes of it do to the hand.
#include "engine/haptics/guidance.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

TEST_CASE("A plane that is lost and found again turns the pull of a free roll without a step") {
    std::array poses{presentAt(0.2)};
    poses[0].target.rotation = rotationExp({0.3, 0, 0}) * rotationExp({0, 0, 1.0});
    Springs springs;
    springs.stiffness = 1000.0;
    springs.rotationalStiffness = 0.1; // [N m/rad]
    Guidance guidance;
    dvec3 before(0.0);
    double most = 0.0, roll = 0.0;
    for (int i = 0; i < 5000; ++i) {
        poses[0].planar = (i / 1000) % 2 == 0;
        guidance.step(poses, {}, true, false, 0.001, guidance.leadReach(springs));
        const dvec3 lead = guidance.lead({}, springs).rotation;
        most = std::max(most, glm::distance(lead, before));
        roll = std::max(roll, std::abs(lead.z));
        before = lead;
    }
    CHECK(roll > 0.5);
    CHECK(most < 0.01);
    CHECK(std::abs(before.z) < 1e-9); // free again
}

TEST_CASE("A shift of the hand map changes no lead") {
    const std::array poses{presentAt(0.2)};
    Springs springs;
    springs.stiffness = 1000.0;
    Guidance guidance;
    Pose hand;
    for (int i = 0; i < 1000; ++i) { // faster than guidance
        hand.position.x = i < 600 ? 0.0 : 0.0002 * (i - 600);
        guidance.step(poses, hand, true, false, 0.001, guidance.leadReach(springs));
    }
    CHECK(glm::length(guidance.lead(hand, springs).translation) < 1e-9);
    const dvec3 by(-0.02, 0, 0);
    guidance.shift(by, {1, 0, 0, 0});
    hand.position += by;
    guidance.step(poses, hand, true, false, 0.001, guidance.leadReach(springs));
    CHECK(glm::length(guidance.lead(hand, springs).translation) <= 0.1 * 0.001 + 1e-9);
}
