// SPDX-License-Identifier: Apache-2.0
// Topics that are not depth by their names, though their encoding may be.
#include "devices/bag/stream_names.h"
#include "tests/devices/played_bag.h"

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Errors, qualities and heights are not depth by the names of their topics") {
    for (const char* topic : {"/cam/depth_error/image", "/cam/depth/error", "/snr/image", "/elevation_map",
                              "/depth/std", "/costmap", "/cam/depth/normals", "/time_surface",
                              "/cam/height/image_raw", "/cam/depth/validity"}) {
        CAPTURE(topic);
        CHECK(namedRole(topic) == NamedRole::Infrared);
    }
    for (const char* topic : {"/surface/depth/image", "/height_camera/depth/image_raw"}) {
        CAPTURE(topic);
        CHECK(namedRole(topic) == NamedRole::Depth);
    }
    CHECK_FALSE(namedOneCamera("/surface1/depth/image", "/surface2/rgb/image")); // names of cameras
}

TEST_CASE("The error of depth is not played instead of depth, in whatever order the topics are") {
    for (const char* error : {"/cam/depth_error/image", "/cam/depth/error"}) {
        const TemporaryFolder folder;
        BagMaker maker;
        addStream(maker, error, depthImage(7));
        addStream(maker, "/cam/depth/image", depthImage(500));
        addStream(maker, "/cam/color/image", redImage());
        BagCamera camera = playStreams(folder, maker);
        CHECK(firstDepth(camera) == doctest::Approx(0.5));
    }
}
