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

TEST_CASE(
    "Colour of the camera whose name is that of depth is played, also in digits and camel case of words") {
    CHECK(sharedWords("/depth1", "/color1") == 1);
    CHECK(sharedWords("/depth1", "/color2") == 0);
    CHECK(sharedWords("/frontDepth", "/frontColor") == 1);
    CHECK(sharedWords("/cam2Depth", "/cam2RGB") == 1);
    CHECK(sharedWords("/c/depth/image_raw/compressedDepth", "/c/color/image_raw/compressed") ==
          sharedWords("/c/depth/image_raw", "/c/color/image_raw"));
    const TemporaryFolder folder;
    for (const auto& [depth, own, other] :
         {std::array<std::string, 3>{"/depth1/image_raw", "/color1/image_raw", "/color2/image_raw"},
          {"/frontDepth/image", "/frontColor/image", "/rearColor/image"}}) {
        BagMaker maker;
        addStream(maker, other, redImage());
        addStream(maker, depth, depthImage(500));
        addStream(maker, own, redImage());
        CHECK(playStreams(folder, maker).streamOptions() == ",depth=" + depth + ",colour=" + own);
    }
}

TEST_CASE("Of two colour cameras whose names say nothing, the one that is nearer to depth is played") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/a/image", redImage("a"), {.frame = "a", .k = {6.0, 6.0, 3.5, 2.5}});
    addStream(maker, "/b/depth", depthImage(500, "b"), {.frame = "b"});
    addStream(maker, "/c/image", redImage("c"), {.frame = "c", .k = {6.0, 6.0, 3.5, 2.5}});
    for (const auto& [frame, x] : {std::pair("a", 1.0), {"b", 0.0}, {"c", 0.03}}) {
        Out link{Out().put(uint32_t{1}).bytes + stampedHeader(1.0, "base")};
        link.text(frame).bytes += transformMessage(x, 0.0, 0.0);
        maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, link.bytes);
    }
    CHECK(playStreams(folder, maker).streamOptions() == ",depth=/b/depth,colour=/c/image");
}
