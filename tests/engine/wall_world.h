// SPDX-License-Identifier: Apache-2.0
// A flat wall at 0.6 m with a region radius of 40 mm, and a ball of 10 mm radius as tool, which rests at z =
// 0.55 m.
#pragma once

#include "tests/support/eventually.h"

#include <fathom/fathom.h>

#include <vector>

namespace fathom::testing {

inline Scene wallScene() {
    return Scene::fromText(R"(
camera: { near: 0.1, far: 3.0 }
error_budget: 0
fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]
tool: { spheres: [[0, 0, 0, 0.01]] }
haptics: { device: ideal, stiffness: 1000 }
)");
}

// Nothing but a box, whose front is at z = 0.55 m: the tool rests at 0.54 m.
inline Scene boxScene() {
    return Scene::fromText(R"(
fixtures: [{ name: box, role: forbidden, shape: box, base_T_shape: { xyz: [0, 0, 1] }, size: [1, 1, 0.9] }]
tool: { spheres: [[0, 0, 0, 0.01]] }
haptics: { device: ideal, stiffness: 1000 }
)");
}

inline CameraModel smallCamera() {
    CameraModel model;
    model.depth = {80, 60, 70.0, 70.0, 40.0, 30.0, {}};
    return model;
}

struct Wall {
    std::vector<std::uint16_t> depth = std::vector<std::uint16_t>(80 * 60, 600);
    Frame at(Nanoseconds stamp) const {
        Frame frame;
        frame.depth = depth.data();
        frame.stamp = stamp;
        return frame;
    }
};

inline Hand handAt(double z) {
    Hand hand;
    hand.deviceThandle.position = {0.0, 0.0, z};
    return hand;
}

inline HandStart startAt(double z) {
    return {handAt(z).deviceThandle};
}

inline bool warns(const Step& step, StepWarning warning) {
    return (step.warnings & warning) != StepWarning::None;
}

} // namespace fathom::testing
