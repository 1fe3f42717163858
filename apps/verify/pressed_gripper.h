// SPDX-License-Identifier: Apache-2.0
// The gripper of the built-in scene, and the distance at which a tool first touches an object.
#pragma once

#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom {

// Tool frame [m], as in apps/scenes/demo.yaml.
inline std::vector<Sphere> gripperLeaves() {
    return {{{0.0, 0.0, -0.14}, 0.020},   {{0.0, 0.0, -0.10}, 0.020},   {{0.0, 0.0, -0.06}, 0.020},
            {{0.0, 0.0, -0.02}, 0.018},   {{0.022, 0.0, 0.010}, 0.012}, {{-0.022, 0.0, 0.010}, 0.012},
            {{0.028, 0.0, 0.035}, 0.010}, {{-0.028, 0.0, 0.035}, 0.010}};
}

// Distance [m], from `low` to `high`, at which touches() first becomes true, to 0.1 um; `high` or more if it
// stays false. Objects must be thicker than the search step of 20 mm.
template <class Touches>
double firstTouch(double low, double high, Touches&& touches) {
    constexpr double kMarch = 0.02; // [m]
    while (low < high && !touches(low + kMarch)) {
        low += kMarch;
    }
    double beyond = low + kMarch;
    for (int k = 0; k < 18; ++k) {
        const double middle = 0.5 * (low + beyond);
        (touches(middle) ? beyond : low) = middle;
    }
    return low;
}

} // namespace fathom
