// SPDX-License-Identifier: Apache-2.0
// A program of somebody else on the installed libraries: reads a scene, presses a tool into a wall of region
// spheres without a GPU, and prints how far it got and what the hand would feel.
#include "engine/contact/cull_cpu.h"
#include "engine/cycle/haptic_cycle.h"
#include "engine/types/version.h"

#include <iostream>

using namespace fathom;

int main(int, char** argv) {
    const Scene scene = loadScene(argv[1]);
    const Tool tool(buildSphereTree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 0.01}}));
    Fixtures wall; // spheres of 40 mm, every 5 mm, 600 mm in front of the camera
    wall.frame = wall.generation = 1;
    for (int i = 0; i < 41 * 41; ++i) {
        wall.spheres.x.push_back(0.005f * static_cast<float>(i % 41 - 20));
        wall.spheres.y.push_back(0.005f * static_cast<float>(i / 41 - 20));
        wall.spheres.z.push_back(0.6f);
        wall.spheres.radius.push_back(0.04f);
        wall.spheres.source.push_back(static_cast<uint32_t>(i));
        wall.spheres.fixture.push_back(0);
    }
    RegionGrid grid;
    grid.build(wall.spheres);
    CullCpu cull;
    ContactSet contacts;
    StepInput input;
    input.deviceThandle.position = {0.0, 0.0, 0.5};
    HapticCycle cycle(tool, {}, makeHapticOptions(scene, tool), input.deviceThandle);
    Wrench felt;
    for (int tick = 0; tick < 200; ++tick, input.time += 0.001) {
        input.deviceThandle.position.z = std::min(0.56, 0.5 + 0.001 * tick); // 10 mm into the wall
        cull.query(tool, cycle.pose(), 0.01, wall, grid, contacts);
        input.contacts = &contacts;
        felt = cycle.step(input).wrench;
    }
    std::cout << version() << " z " << cycle.pose().position.z << " force " << felt.force.z << "\n";
}
