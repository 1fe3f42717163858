// SPDX-License-Identifier: Apache-2.0
// How depth and colour of a bag are related where frames, topics and tf say different things.
#include "tests/devices/played_bag.h"

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Colour of a right camera is the baseline apart in the frame of depth named registered") {
    const TemporaryFolder folder;
    const std::array<double, 4> lens{7.0, 7.0, 3.5, 2.5};
    for (const char* depth : {"/stereo/depth_registered/image_rect", "/stereo/depth/image_rect"}) {
        BagMaker maker;
        addStream(maker, depth, depthImage(500), {.p = lens});
        addStream(maker, "/stereo/right/image_rect_color", redImage(), {.p = lens, .tx = -0.84});
        const CameraInfo info = playStreams(folder, maker).info();
        CHECK_FALSE(info.registered);
        CHECK(info.colourTdepth.position.x == doctest::Approx(-0.12));
    }
    BagMaker aligned; // a driver writes the same P for all of its images
    addStream(aligned, "/camera/aligned_depth_to_color/image_raw", depthImage(500), {.p = lens, .tx = -0.84});
    addStream(aligned, "/camera/color/image_raw", redImage(), {.p = lens});
    CHECK(playStreams(folder, aligned).info().registered);
}
