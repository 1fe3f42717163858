// SPDX-License-Identifier: Apache-2.0
// Registration of a camera with two lenses to a flat target, at a known pose.
#pragma once

#include "engine/types/camera_info.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::testing {

inline const Pose kBaseTcamera{{0.4, -0.3, 1.2}, glm::normalize(dquat(0.3, 0.8, -0.4, 0.2))};

// [rad]
inline double angleBetween(const dquat& a, const dquat& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

// Depth of 320 x 240 and colour of 640 x 480 pixels, not registered.
inline CameraInfo twoLensCamera() {
    CameraInfo info;
    info.depth = {.width = 320, .height = 240, .fx = 280, .fy = 281, .cx = 161, .cy = 119};
    info.colour = {.width = 640, .height = 480, .fx = 600, .fy = 601, .cx = 318, .cy = 243};
    info.registered = false;
    info.colourTdepth = {{0.015, 0.001, -0.002}, glm::normalize(dquat(1.0, 0.004, -0.006, 0.002))};
    info.metresPerUnit = 0.0005;
    return info;
}

// Intersection of a camera's ray with the plane z = 0 of the target, in the camera's frame [m].
inline dvec3 hitOnPlane(const glm::dvec2& ray, const Pose& cameraTtarget) {
    const dvec3 n = cameraTtarget.rotation * dvec3(0, 0, 1), d(ray, 1.0);
    return d * (glm::dot(cameraTtarget.position, n) / glm::dot(d, n));
}

} // namespace fathom::testing
