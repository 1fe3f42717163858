// SPDX-License-Identifier: Apache-2.0
// Arms and worlds for the tests of the arm's proxy.
#pragma once

#include "engine/contact/cull_cpu.h"
#include "engine/haptics/arm_proxy.h"
#include "tests/contact/clouds.h"

namespace fathom::testing {

// Links of 0.25 m along x, joints alternately about z and y, `spheres` leaves of 4 cm along each link.
inline ArmModel makeArm(size_t joints, size_t spheres, double limit = 1.2) {
    ArmModel arm;
    for (size_t k = 0; k < joints; ++k) {
        ArmJoint joint;
        joint.name = std::to_string(k);
        joint.before.position = k == 0 ? dvec3(0.0) : dvec3(0.25, 0.0, 0.0);
        joint.axis = k % 2 == 0 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
        joint.lower = -limit;
        joint.upper = limit;
        joint.speed = 1.0;
        arm.joints.push_back(joint);
        for (size_t i = 0; i < spheres; ++i) {
            const double at = 0.25 * (static_cast<double>(i) + 0.5) / static_cast<double>(spheres);
            arm.leaves.push_back(
                {{{at, 0.0, 0.0}, 0.04}, static_cast<uint32_t>(k + 1), static_cast<uint32_t>(k)});
        }
        arm.links.push_back(std::to_string(k));
    }
    arm.lastTtip.position = {0.25, 0.0, 0.0};
    return arm;
}

struct World {
    HostFixtures fixtures = emptySet();
    RegionGrid grid;
    CullCpu cull;
    ContactSet set;

    void query(const ArmModel& arm, const ArmProxy& proxy) {
        cull.query(armTool(arm, proxy.frames()), Pose{}, 0.01, fixtures, grid, set);
    }
    // Deepest overlap of any leaf with any sphere [m], by brute force.
    double depth(const ArmModel& arm, const ArmFrames& frames) const {
        double deepest = -1.0;
        const RegionSpheres& s = fixtures.spheres;
        for (size_t l = 0; l < arm.leaves.size(); ++l) {
            const dvec3 c = arm.centre(frames, l) - fixtures.origin;
            for (size_t i = 0; i < s.size(); ++i) {
                const double gap = glm::distance(c, dvec3(s.x[i], s.y[i], s.z[i])) -
                                   static_cast<double>(s.radius[i]) - arm.leaves[l].sphere.radius;
                deepest = std::max(deepest, -gap);
            }
        }
        return deepest;
    }
};

// Spheres around the arm; none touches it at the start.
inline void scatter(World& world, const ArmModel& arm, const ArmFrames& frames, std::mt19937_64& random,
                    size_t count) {
    while (world.fixtures.spheres.size() < count) {
        const dvec3 c = randomIn(random, 1.0);
        bool clear = true;
        for (size_t l = 0; l < arm.leaves.size() && clear; ++l) {
            clear = glm::distance(c, arm.centre(frames, l)) > 0.03 + 0.002 + arm.leaves[l].sphere.radius;
        }
        if (clear) {
            world.fixtures.spheres.add(c, 0.03);
        }
    }
    world.grid.build(world.fixtures.spheres);
}

} // namespace fathom::testing
