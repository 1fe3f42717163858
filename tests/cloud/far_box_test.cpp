// SPDX-License-Identifier: Apache-2.0
// Box gates of a camera that has moved far from the origin, where float32 positions are coarser.
#include "tests/support/cloud_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A box accepts points exactly on its faces where the camera has moved up to 1 km") {
    CameraInfo camera = pinholeCamera(40, 40); // below: x = (u - 20) z / 100
    camera.depth.fx = camera.depth.fy = 100.0, camera.depth.cx = camera.depth.cy = 20.0;
    for (const int z : {500, 777, 999, 2047}) {
        const double metres = 0.001 * z;
        const Image image = drawnImage(camera, [&](int, int) { return metres; });
        for (const dvec3 away : {dvec3(3.3, -4.7, 9.1), dvec3(47.3, -93.7, 60.1), dvec3(700.3, -300.7, 600.1),
                                 dvec3(-577.01, 577.03, -577.07), dvec3(999.9, 0.3, 0.7)}) {
            CAPTURE(z);
            CAPTURE(away.x);
            Scene scene = plainScene();
            scene.fixtures[0].box = Box{away + dvec3(-0.1 * metres, -0.05 * metres, metres),
                                        away + dvec3(0.07 * metres, 0.05 * metres, metres)};
            CloudRig rig(scene, camera);
            CHECK(rig.run(image).counts.classPixels[0] == 0); // the first pose is the origin
            const FrameReport report = rig.run(image, -1.0, Pose{away});
            REQUIRE(rig.origin() == dvec3(0.0));
            CHECK(report.counts.classPixels[0] == 18 * 11);
        }
    }
}
