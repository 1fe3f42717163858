// SPDX-License-Identifier: Apache-2.0
// The rig of the precision cases, with cameras, scenes and images that scale with the range.
#pragma once

#include "apps/verify/pass_rig.h"

namespace fathom::stability {

using verify::Image;

// Always builds the tree of bounds, even if no query uses it, because the cases check it, too.
struct PrecisionRig : verify::PassRig {
    PrecisionRig(gpu::Device& device, Scene scene, const CameraInfo& camera)
        : PassRig(device, std::move(scene), camera, [](Plan& plan) { plan.tree = plan.spheres; }) {}
};

// Pinhole camera without distortion. The depth unit is range / 20 000.
CameraInfo cameraFor(double range, uint32_t width = 96, uint32_t height = 72);

// Near and far bounds, radii and boxes scaled to the range [m]. Has one forbidden class (red) and one
// guidance class (everything in the left two thirds).
Scene sceneFor(double range);

// A slope with a step and waves, scaled to the range. noise: relative standard deviation of a depth. Some
// pixels have no depth.
Image imageFor(const CameraInfo& camera, double range, double noise, uint64_t seed);

} // namespace fathom::stability
