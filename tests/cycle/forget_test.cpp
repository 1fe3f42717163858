// SPDX-License-Identifier: Apache-2.0
// A frame cycle that jumps back and forth in time.
#include "tests/support/cloud_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("After forget() a used cycle gives the sets of a fresh one, held points included, also at an "
          "earlier time") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene scene = classesScene(3);
    scene.holdSeconds = 0.2;
    CloudRig used(scene, camera);
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        used.run(stressImage(camera, seed), 5.0 + static_cast<double>(seed) / 30.0);
    }
    const size_t withMemory = used.host().spheres.size();
    used.run(stressImage(camera, 4), 5.1 + 4.0 / 30.0);
    used.cycle().forget();
    CloudRig fresh(scene, camera);
    for (int k = 0; k < 3; ++k) {
        const Image image = stressImage(camera, 4 + static_cast<uint64_t>(k));
        fresh.run(image, k / 30.0);
        used.run(image, k / 30.0);
        CAPTURE(k);
        CHECK(used.host().spheres.x == fresh.host().spheres.x);
        CHECK(used.host().spheres.radius == fresh.host().spheres.radius);
        CHECK(used.host().spheres.source == fresh.host().spheres.source);
        if (k == 0) {
            CHECK(used.host().spheres.size() < withMemory); // no points are held
        }
    }
}
