// SPDX-License-Identifier: Apache-2.0
// A fixture set with its depth image: a wall across the view of a camera at the origin that looks along +z.
#pragma once

#include "tests/contact/clouds.h"

#include <cmath>

namespace fathom::testing {

// Every pixel sees the wall at depth z [m] (to the unit of the depth image, 0.1 mm) and is forbidden.
// spheres: one per pixel in the middle of the wall, with +-noise [m] along the ray; none when radius is 0.
inline HostFixtures wallImage(double z, uint64_t generation, double radius = 0.0, double noise = 0.0) {
    HostFixtures set = emptySet(generation);
    Intrinsics& lens = set.camera.depth;
    lens.width = 160, lens.height = 120;
    lens.fx = lens.fy = 140.0;
    lens.cx = 79.5, lens.cy = 59.5;
    set.camera.colour = lens;
    set.camera.metresPerUnit = 0.0001;
    set.depth.resize(lens.pixels());
    set.forbiddenBits.assign((lens.pixels() + 31) / 32, ~0u);
    std::mt19937_64 random(generation * 7919 + 1);
    std::normal_distribution<double> n(0.0, 1.0);
    for (uint32_t v = 0; v < lens.height; ++v) {
        for (uint32_t u = 0; u < lens.width; ++u) {
            const double seen = z + noise * n(random);
            set.depth[v * lens.width + u] =
                static_cast<uint16_t>(std::lround(seen / set.camera.metresPerUnit));
            if (radius > 0.0) {
                const glm::dvec2 ray = lens.ray(u, v);
                set.spheres.add(seen * dvec3(ray.x, ray.y, 1.0), radius);
                set.spheres.source.back() = v * lens.width + u;
            }
        }
    }
    return set;
}

} // namespace fathom::testing
