// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/start_notes.h"

#include "engine/contact/shapes.h"
#include "engine/types/log.h"
#include "engine/types/printed.h"

#include <algorithm>

namespace fathom {

namespace {

// [m] A run may start in contact, a little inside. At usual stiffness a hand does not feel less than this.
constexpr double kFeltDepth = 1e-4;

// A sphere that shapes constrain at the start.
struct StartSphere {
    size_t part = 0; // index of its name
    Sphere sphere;   // base frame
};

// The spheres that shapes constrain, and the names of the links that carry them.
struct StartSpheres {
    std::vector<StartSphere> spheres;
    std::vector<std::string> parts;
};

StartSpheres spheresOfArm(const ArmSetup& arm, const ArmPosture& posture) {
    const ArmFrames frames = arm.framesAt(posture);
    StartSpheres all;
    for (const std::string& link : arm.model.links) {
        all.parts.push_back(link == "tool" ? "the tool" : "link " + link);
    }
    for (size_t i = 0; i < arm.model.leaves.size(); ++i) {
        if (arm.model.moves(i)) {
            const ArmLeaf& leaf = arm.model.leaves[i];
            all.spheres.push_back({leaf.link, {arm.model.centre(frames, i), leaf.sphere.radius}});
        }
    }
    return all;
}

StartSpheres spheresOfTool(const Tool& tool, const Pose& baseTtool) {
    StartSpheres all{{}, {"the tool"}};
    for (const Sphere& leaf : tool.leaves()) {
        all.spheres.push_back({0, {baseTtool.apply(leaf.centre), leaf.radius}});
    }
    return all;
}

std::string startNote(const std::string& fixture, bool keepIn, const std::string& part, double depth) {
    return "fixture '" + fixture + "': " + part + " starts " +
           printed(depth < 0.1 ? "%.3g mm " : "%.0f mm ", 1e3 * depth) +
           (keepIn ? "outside of it and is moved in" : "inside of it and is moved out") +
           "; the hand feels up to the force limit";
}

} // namespace

std::vector<std::string> startNotes(const Scene& scene, const Tool& tool, const ArmSetup* arm,
                                    const ToolPlace& start) {
    const StartSpheres all = arm != nullptr ? spheresOfArm(*arm, start.arm) : spheresOfTool(tool, start.pose);
    std::vector<std::string> notes;
    for (const Shape& shape : shapesOf(scene)) {
        if (shape.isEquality() || (shape.keepIn && arm != nullptr)) {
            continue;
        }
        std::vector<double> depths(all.parts.size());
        for (const StartSphere& at : all.spheres) {
            depths[at.part] =
                std::max(depths[at.part], -gapTo(shape, at.sphere.centre, at.sphere.radius).gap);
        }
        for (size_t part = 0; part < depths.size(); ++part) {
            if (depths[part] > kFeltDepth) {
                notes.push_back(startNote(scene.fixtures[shape.fixture].name, shape.keepIn, all.parts[part],
                                          depths[part]));
            }
        }
    }
    return notes;
}

void warnOfStart(const Scene& scene, const Tool& tool, const ArmSetup* arm, const ToolPlace& start) {
    for (const std::string& note : startNotes(scene, tool, arm, start)) {
        log::warn("{}", note);
    }
}

} // namespace fathom
