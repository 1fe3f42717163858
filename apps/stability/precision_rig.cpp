// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/precision_rig.h"

#include "engine/reference/rng.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

CameraInfo cameraFor(double range, uint32_t width, uint32_t height) {
    CameraInfo camera;
    camera.depth.width = width;
    camera.depth.height = height;
    camera.depth.fx = 1.1 * width;
    camera.depth.fy = 1.12 * width;
    camera.depth.cx = 0.49 * width;
    camera.depth.cy = 0.53 * height;
    camera.colour = camera.depth;
    camera.metresPerUnit = range / 20000.0;
    return camera;
}

Scene sceneFor(double range) {
    Scene scene;
    scene.nearZ = 0.3 * range;
    scene.farZ = 2.5 * range;
    scene.baseTcamera = {{0.4 * range, -0.3 * range, 0.2 * range}, rotationExp({0.5, -0.7, 0.2})};
    scene.filter = {2, 0.01 * range, 0.03};
    scene.errorBudget = 3e-3 * range;
    scene.holdSeconds = 0.0;
    scene.registrationSigma = 1e-4 * range;
    scene.fixtures.resize(2);
    scene.fixtures[0].name = "red";
    scene.fixtures[0].hue = Band{330.0, 30.0};
    scene.fixtures[0].radius = 0.06 * range;
    scene.fixtures[1].name = "goal";
    scene.fixtures[1].role = Role::Guidance;
    scene.fixtures[1].minCount = 3;
    const dvec3 centre = scene.baseTcamera.apply({-0.1 * range, 0.0, range});
    scene.fixtures[1].box = Box{centre - dvec3(0.4 * range), centre + dvec3(0.4 * range)};
    return scene;
}

Image imageFor(const CameraInfo& camera, double range, double noise, uint64_t seed) {
    Rng rng(seed);
    Image image;
    const uint32_t w = camera.depth.width, h = camera.depth.height;
    for (uint32_t v = 0; v < h; ++v) {
        for (uint32_t u = 0; u < w; ++u) {
            const double x = (u + 0.5) / w, y = (v + 0.5) / h;
            double z = 0.9 + 0.25 * x + 0.05 * std::sin(9.0 * y) * std::cos(7.0 * x);
            z -= std::hypot(x - 0.6, y - 0.45) < 0.2 ? 0.3 : 0.0;
            z *= 1.0 + noise * rng.normal();
            const bool none = noise > 0.0 && rng.chance(0.04);
            image.depth.push_back(none ? uint16_t{0}
                                       : static_cast<uint16_t>(std::clamp(
                                             std::round(z * range / camera.metresPerUnit), 0.0, 65535.0)));
        }
    }
    for (uint32_t i = 0; i < camera.colour.pixels(); ++i) {
        const uint32_t column = i % camera.colour.width;
        image.colour.push_back(column % 16 < 11 ? 0xff2020c0u : 0xff808080u);
    }
    return image;
}

} // namespace fathom::stability
