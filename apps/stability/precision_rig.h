// SPDX-License-Identifier: Apache-2.0
// What the precision cases measure, and on what: cameras, scenes and images that scale with the range.
#pragma once

#include "apps/verify/pass_rig.h"

namespace fathom::stability {

using verify::Image;

// With a tree of bounds, whether a query walks it or not: it is looked at, too.
struct PrecisionRig : verify::PassRig {
    PrecisionRig(gpu::Device& device, Scene scene, const CameraInfo& camera)
        : PassRig(device, std::move(scene), camera, [](Plan& plan) { plan.tree = plan.spheres; }) {}
};

// Pinhole without distortion; depth unit so that `range` is 20 000 units.
CameraInfo cameraFor(double range, uint32_t width = 96, uint32_t height = 72);

// Near and far bounds, radii and boxes that suit a range; one forbidden class of red, one guidance class of
// everything in the left two thirds.
Scene sceneFor(double range);

// A slope with a step and waves in it, scaled to the range; noise: 0 or the relative standard deviation of a
// depth. Some pixels have none.
Image imageFor(const CameraInfo& camera, double range, double noise, uint64_t seed);

} // namespace fathom::stability
