// SPDX-License-Identifier: Apache-2.0
// Pairs of points for registration.
#pragma once

#include "apps/register/rigid_fit.h"
#include "tests/apps/two_lens_camera.h"

#include <doctest/doctest.h>
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

// The camera at kBaseTcamera is found from pairs of an image whose depth has this noise [m]. most: error of
// the pose [m], [rad].
inline void checkRegistered(const std::vector<PointPair>& pairs, double noise, double most) {
    const RigidFit fit = fitRigid(pairs, "test");
    const double shift = glm::length(fit.baseTcamera.position - kBaseTcamera.position);
    CHECK(shift < most);
    CHECK(angleBetween(fit.baseTcamera.rotation, kBaseTcamera.rotation) < most);
    CHECK(fit.sigma < 0.002);
    MESSAGE("noise " << noise << " m: position off by " << 1e3 * shift << " mm, sigma " << 1e3 * fit.sigma
                     << " mm");
}

} // namespace fathom::testing
