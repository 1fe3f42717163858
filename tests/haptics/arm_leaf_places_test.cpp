// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_leaf_places.h"

#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Leaf centres match the arm model for any order of frames") {
    ArmModel arm = makeArm(5, 7);
    ArmFinger finger;
    finger.joint = 5;
    finger.before.position = {0.01, 0.02, 0.1};
    finger.closed = 0.6;
    arm.fingers.push_back(finger);
    for (size_t i = 0; i < arm.leaves.size(); i += 3) { // frames change from leaf to leaf
        arm.leaves[i].joint = 0;
    }
    arm.leaves[1].joint = 5, arm.leaves[1].finger = 1;
    const ArmLeafPlaces places(arm);
    const dvec3 origin(1.0, -2.0, 0.5);
    LeafCentres placed(arm.leaves.size());
    for (const double turn : {0.0, 0.3, -1.1}) {
        JointVector q{};
        q.fill(turn);
        ArmFrames frames;
        arm.place(q, {{0.4, 0.1, -0.2}, rotationExp({0.3, turn, 0.1})}, frames, 0.7);
        places.place(frames, origin, placed);
        double worst = 0.0;
        for (size_t i = 0; i < arm.leaves.size(); ++i) {
            worst = std::max(worst, glm::distance(placed[i] + origin, arm.centre(frames, i)));
        }
        CHECK(worst < 1e-14);
    }
}
