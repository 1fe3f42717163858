// SPDX-License-Identifier: Apache-2.0
// Where the spheres of an arm are.
#include "engine/cycle/arm_setup.h"

namespace fathom {

ArmFrames ArmSetup::framesAt(const ArmPosture& posture) const noexcept {
    ArmFrames frames;
    model.place(posture.q, baseTarm, frames, posture.grasp);
    return frames;
}

std::vector<Sphere> ArmSetup::aboutTip(const ArmPosture& posture) const {
    const ArmFrames frames = framesAt(posture);
    const Pose tipTbase = inverse(model.tip(frames));
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < model.leaves.size(); ++i) {
        spheres.push_back({tipTbase.apply(model.centre(frames, i)), model.leaves[i].sphere.radius});
    }
    return spheres;
}

cloud::ArmSpheres ArmSetup::inImage(const ArmPosture& posture) const {
    const ArmFrames frames = framesAt(posture);
    cloud::ArmSpheres arm;
    for (size_t i = 0; i < model.leaves.size(); ++i) {
        if (i > 0 && model.leaves[i].link != model.leaves[i - 1].link) {
            arm.ends.push_back(static_cast<uint32_t>(i));
        }
        arm.spheres.push_back({model.centre(frames, i), model.leaves[i].sphere.radius + padding});
    }
    arm.ends.push_back(static_cast<uint32_t>(model.leaves.size()));
    return arm;
}

Tool ArmSetup::heldTool() const {
    const std::vector<Sphere> all = aboutTip({start, 0.0});
    std::vector<Sphere> held;
    for (size_t i = 0; i < all.size(); ++i) {
        if (model.leaves[i].joint == model.count()) {
            held.push_back(all[i]);
        }
    }
    return Tool(buildSphereTree(held.empty() ? all : held));
}

} // namespace fathom
