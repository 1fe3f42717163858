// SPDX-License-Identifier: Apache-2.0
// Postures that an arm takes over.
#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A posture's grasp is moved between open and closed, and one that is not known changes nothing") {
    ArmModel arm = makeArm(4, 2);
    ArmProxy proxy(arm, Pose{}, ArmProxyOptions{}, JointVector{});
    for (const auto& [asked, taken] : {std::pair(1.7, 1.0), {-0.3, 0.0}, {0.4, 0.4}, {std::nan(""), 0.4}}) {
        proxy.setPosture({JointVector{}, asked});
        CHECK(proxy.posture().grasp == taken);
    }
}
