// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/arm_overlaps.h"

#include "engine/contact/shapes.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kTouching = 1e-6; // [m]
constexpr size_t kMaxNamed = 4;    // links

std::string namesOf(const std::vector<std::string>& links) {
    std::string names = links.size() == 1 ? "link " : "links ";
    for (size_t i = 0; i < links.size() && i < kMaxNamed; ++i) {
        names += (i == 0 ? "" : ", ") + links[i];
    }
    return links.size() > kMaxNamed ? names + ", ..." : names;
}

} // namespace

std::vector<std::string> startOverlaps(const ArmSetup& arm, const Scene& scene) {
    const ArmFrames frames = arm.framesAt(arm.startPosture());
    std::vector<std::string> notes;
    for (const Shape& shape : shapesOf(scene)) {
        std::vector<std::string> links;
        for (size_t i = 0; i < arm.model.leaves.size() && !shape.isEquality(); ++i) {
            const ArmLeaf& leaf = arm.model.leaves[i];
            const bool stuck = shape.keepIn || (leaf.joint == 0 && leaf.finger == 0);
            const std::string& name = arm.model.links[leaf.link];
            if (stuck && std::find(links.begin(), links.end(), name) == links.end() &&
                gapTo(shape, arm.model.centre(frames, i), leaf.sphere.radius).gap < -kTouching) {
                links.push_back(name);
            }
        }
        if (links.empty()) {
            continue;
        }
        const std::string fixture = "fixture '" + scene.fixtures[shape.fixture].name + "': ";
        notes.push_back(shape.keepIn ? fixture + namesOf(links) +
                                           " outside of it at the start: keep_in holds all links of the arm, "
                                           "so it pulls them inside, and the hand feels that"
                                     : fixture + namesOf(links) +
                                           " inside of it, which no joint moves: the "
                                           "state is escape in all ticks");
    }
    return notes;
}

} // namespace fathom
