// SPDX-License-Identifier: Apache-2.0
// The wall of wall_world.h and an arm before it: one joint slides along z and carries a ball of 10 mm radius,
// which is at z = q + 0.3 m. The scene `fingerScene` adds one finger at the tip, 20 mm from the ball.
#pragma once

#include "tests/engine/wall_world.h"
#include "tests/support/scratch_folder.h"

#include <filesystem>
#include <string>

namespace fathom::testing {

// A folder with the arm's URDF.
class ArmFolder {
public:
    ArmFolder() {
        folder_.write(
            "slide.urdf",
            "<robot name='slide'><link name='base'/><link name='tip'><collision><geometry>"
            "<sphere radius='0.01'/></geometry></collision></link><joint name='slide' type='prismatic'>"
            "<parent link='base'/><child link='tip'/><origin xyz='0 0 0.3'/><axis xyz='0 0 1'/>"
            "<limit effort='1' velocity='1' lower='0' upper='0.5'/></joint></robot>");
        folder_.write(
            "finger.urdf",
            "<robot name='finger'><link name='base'/><link name='tip'><collision><geometry>"
            "<sphere radius='0.01'/></geometry></collision></link><link name='f'><collision>"
            "<origin xyz='0 0.02 0.03'/><geometry><sphere radius='0.005'/></geometry></collision></link>"
            "<joint name='slide' type='prismatic'><parent link='base'/><child link='tip'/>"
            "<origin xyz='0 0 0.3'/><axis xyz='0 0 1'/><limit effort='1' velocity='1' lower='0' "
            "upper='0.5'/></joint><joint name='finger' type='revolute'><parent link='tip'/>"
            "<child link='f'/><axis xyz='1 0 0'/><limit effort='1' velocity='1' lower='-1' upper='1'/>"
            "</joint></robot>");
        folder_.write(
            "ball.urdf",
            "<robot name='ball'><link name='ball'><collision><geometry><sphere radius='0.01'/></geometry>"
            "</collision></link></robot>");
    }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

    // The wall's scene with other lines for `tool:`, and more.
    Scene scene(const std::string& more) const {
        folder_.write("scene.yaml", "camera: { near: 0.1, far: 3.0 }\nerror_budget: 0\n"
                                    "fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]\n" +
                                        more);
        return Scene::fromFile(folder_ / "scene.yaml");
    }
    Scene armScene() const {
        return scene("arm: { urdf: slide.urdf, tip: tip, direction: free, self_filter: 0.02,\n"
                     "       joints: [{ name: slide, start: 0.2 }] }\n"
                     "haptics: { device: ideal, stiffness: 1000 }\n");
    }
    Scene fingerScene() const {
        return scene("arm: { urdf: finger.urdf, tip: tip, direction: free, self_filter: 0.02,\n"
                     "       joints: [{ name: slide, start: 0.2 }],\n"
                     "       grasp: { fingers: [{ joint: finger, open: 0.5, closed: 0.0 }] } }\n"
                     "haptics: { device: ideal, stiffness: 1000 }\n");
    }

private:
    ScratchFolder folder_;
};

} // namespace fathom::testing
