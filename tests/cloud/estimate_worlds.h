// SPDX-License-Identifier: Apache-2.0
// A noisy surface whose true place is known, for the tests of the depth estimates.
#pragma once

#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace fathom::testing {

// A wavy wall that moves along the optical axis, in units of 0.1 mm.
struct NoisyWorld {
    NoisyWorld(double range, double share, uint32_t seed)
        : camera(pinholeCamera(48, 40, 0.0001))
        , truth(camera.depth.pixels())
        , range_(range)
        , share_(share)
        , random_(seed) {}

    // The next frame, `step` [m] farther than the last one.
    Image next(double step) {
        range_ += step;
        Image image = drawnImage(camera, [&](int u, int v) {
            double& z = truth[static_cast<size_t>(v) * camera.depth.width + static_cast<size_t>(u)];
            z = range_ + 0.002 * std::sin(0.1 * u) + 0.03 * range_ / camera.depth.fx * v;
            return z + share_ * depthSigma(z) * normal_(random_);
        });
        return image;
    }

    CameraInfo camera;
    std::vector<double> truth; // [m] of the last frame

private:
    double range_, share_;
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
};

inline Scene estimateScene(uint32_t frames) {
    Scene scene = plainScene();
    scene.fixtures[0].radius = 0.2;
    scene.filter.radius = 2, scene.filter.edge = 0.03, scene.filter.memory = frames;
    return scene;
}

// 99.9th percentiles [m] over all pixels of moving frames.
struct Errors {
    double farther = 0.0, plainFarther = 0.0, nearer = 0.0, plainNearer = 0.0;
};

inline double percentile999(std::vector<double> values) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// Away from the image's border, where half a filter window biases the plain points, too.
inline bool isInside(const CloudRig& rig, size_t i) {
    const int u = static_cast<int>(i) % rig.width(), v = static_cast<int>(i) / rig.width();
    return std::min({u, v, rig.width() - 1 - u, rig.height() - 1 - v}) >= 2;
}

// A surface that rests for 30 frames, then moves at `speed` [m/s] for 14 frames of 1/30 s. share: noise, in
// standard deviations of the program's model. Of receding surfaces the first two frames do not count.
inline Errors errorsAt(CloudRig& rig, CloudRig& plain, double range, double share, double speed) {
    NoisyWorld world(range, share, 7);
    rig.cycle().forget();
    plain.cycle().forget();
    std::vector<double> errors, plainErrors;
    for (int k = 0; k < 44; ++k) {
        const double left = range + std::min(0.0, speed) * (k - 29) / 30.0;
        const Image image = world.next(k >= 30 && left > 0.16 ? speed / 30.0 : 0.0);
        rig.run(image, -1.0, Pose{}), plain.run(image, -1.0, Pose{});
        const std::vector<double> z = rig.points().z, plainZ = plain.points().z;
        for (size_t i = 0; k >= (speed > 0.0 ? 32 : 30) && i < z.size(); ++i) {
            if (z[i] != 0.0 && plainZ[i] != 0.0 && isInside(rig, i)) {
                errors.push_back(z[i] - world.truth[i]), plainErrors.push_back(plainZ[i] - world.truth[i]);
            }
        }
    }
    Errors e{percentile999(errors), percentile999(plainErrors), 0.0, 0.0};
    std::ranges::for_each(errors, [](double& x) { x = -x; });
    std::ranges::for_each(plainErrors, [](double& x) { x = -x; });
    e.nearer = percentile999(errors), e.plainNearer = percentile999(plainErrors);
    return e;
}

} // namespace fathom::testing
