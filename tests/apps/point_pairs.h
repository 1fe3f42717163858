// SPDX-License-Identifier: Apache-2.0
// Pairs of points for registration.
#pragma once

#include "apps/register/point_pairs.h"
#include "tests/apps/two_lens_camera.h"

#include <random>
#include <string>
#include <vector>

namespace fathom::testing {

// Random points in front of the camera at kBaseTcamera. noise: standard deviation per axis [m].
inline std::vector<PointPair> pairsOf(size_t count, double noise, unsigned seed = 5) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-0.5, 0.5);
    std::normal_distribution<double> error(0.0, 1.0);
    std::vector<PointPair> pairs;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 p(place(random), place(random), 1.0 + place(random));
        const dvec3 e(error(random), error(random), error(random));
        pairs.push_back({p, kBaseTcamera.apply(p) + noise * e, "line " + std::to_string(i + 2)});
    }
    return pairs;
}

} // namespace fathom::testing
