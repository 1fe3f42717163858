// SPDX-License-Identifier: Apache-2.0
// A haptic rig whose tool is the tip of a stretched arm, with a ball next to it.
#pragma once

#include "tests/cycle/haptic_rig.h"
#include "tests/haptics/arm_proxy_world.h"

#include <memory>
#include <utility>

namespace fathom::testing {

struct StretchedArm {
    double limit = 1.2; // [rad] of each joint
    double speed = 1.0; // [rad/s] of each joint
};

inline std::unique_ptr<ArmSetup> makeSetup(const StretchedArm& wanted) {
    auto setup = std::make_unique<ArmSetup>();
    setup->model = makeArm(4, 8, wanted.limit);
    for (ArmJoint& joint : setup->model.joints) {
        joint.speed = wanted.speed;
    }
    setup->freeDirection = true;
    setup->proxy.stepCap = 0.002;
    return setup;
}

// The tip is at x = 1 m. A ball of 50 mm blocks the path of the last leaves along y.
class ArmCycleRig : public HapticRig {
public:
    explicit ArmCycleRig(const StretchedArm& wanted = {})
        : HapticRig(handScene(), at(0, 0, 0), ballTool(), makeSetup(wanted)) {
        scene.sourceEnded = true; // sets do not age
        showBall(0.16);
    }

    // y [m] of the ball's centre from now on.
    void showBall(double y) {
        HostFixtures set = emptySet(++generation_);
        set.spheres.add({0.95, y, 0.0}, 0.05);
        show(std::move(set));
        sceneAges = false;
    }

private:
    uint64_t generation_ = 0;
};

} // namespace fathom::testing
