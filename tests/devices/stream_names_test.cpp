// SPDX-License-Identifier: Apache-2.0
// Topics that are not depth by their names, though their encoding may be.
#include "devices/bag/stream_names.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

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

TEST_CASE("Inverse depth, and what programs compute from depth, are not depth by their names") {
    for (const char* topic : {"/cam/inverse_depth",
                              "/inverse_depth/image",
                              "/cam/inv_depth",
                              "/cam/depth_inv",
                              "/cam/depth_inverse/image",
                              "/cam/inverseDepth",
                              "/cam/depthInverse",
                              "/cam/idepth",
                              "/cam/invdepth",
                              "/cam/log_depth",
                              "/cam/depth_normalized",
                              "/cam/normalised_depth",
                              "/cam/relative_depth",
                              "/cam/depth/relative",
                              "/cam/depth_diff",
                              "/depth_diff/image",
                              "/cam/depth/gradient/image",
                              "/cam/depth_gradients",
                              "/cam/depth_weights",
                              "/cam/depth_prob",
                              "/cam/depth_probability",
                              "/cam/depth_edges",
                              "/cam/depth_flow",
                              "/cam/depth_residual",
                              "/cam/depth/curvature",
                              "/cam/depth_edge_image",
                              "/cam/depth_flow/image_raw",
                              "/depth/gradient/image_raw",
                              "/depth_conf/image"}) {
        CAPTURE(topic);
        CHECK(namedRole(topic) == NamedRole::Infrared);
    }
    for (const char* topic :
         {"/cam/depth_registered/image_raw", "/cam/aligned_depth_to_color/image_raw",
          "/cam/depth/image_rect_raw", "/edge/depth/image", "/edge_camera/depth/image", "/flow/depth",
          "/cam/edge_depth", "/log/depth/image", "/relative/depth/image", "/cam/depth_relative_to_base",
          "/robot/norm/depth", "/cam/depth_scaled", "/cam/depth_filtered/image"}) {
        CAPTURE(topic);
        CHECK(namedRole(topic) == NamedRole::Depth);
    }
    for (const char* topic :
         {"/cam/depth_edge_preserving/image", "/cam/depth_edges_removed/image",
          "/cam/depth_without_edges/image", "/cam/depth_edge_filtered/image", "/cam/depth_flow_aligned",
          "/cam/depth_inv_brown/image", "/camera/depth/edge_cam/image", "/depth/flow/image_raw",
          "/depth/edge/image_raw"}) { // filters, a lens model and computers
        CAPTURE(topic);
        CHECK(namedRole(topic) == NamedRole::Depth);
    }
    CHECK(namedRole("/edge/camera/image") == NamedRole::None); // a computer
    CHECK(namedRole("/edge/color/image") == NamedRole::Colour);
    CHECK(namedDepthImage("/cam/inverse_depth/image")); // painted where its encoding is colour
}

TEST_CASE(
    "A bag whose only image is computed from depth is refused with the kinds of names that are left out") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/cam/depth_gradient", depthImage(2000));
    mentions(streamRefusal(folder, maker), "whose name is not one of infrared, inverse depth, or images "
                                           "computed from depth (edges, gradient); mono16");
}

TEST_CASE("What is computed from depth is not played instead of it, in whatever order the topics are") {
    for (const char* other : {"/cam/inverse_depth", "/cam/depth_gradient", "/cam/depth_estimate/image"}) {
        for (const bool colour : {false, true}) {
            const TemporaryFolder folder;
            BagMaker maker;
            addStream(maker, other, depthImage(2000));
            addStream(maker, "/cam/depth", depthImage(500));
            if (colour) {
                addStream(maker, "/cam/color", redImage());
            }
            BagCamera camera = playStreams(folder, maker);
            CAPTURE(other);
            CHECK(firstDepth(camera) == doctest::Approx(0.5));
        }
    }
    for (const char* own :
         {"/a/depth/image_raw", "/a/depth_registered/image", "/a/depth0/image", "/a/depth"}) {
        CHECK(namedPlainly(own));
    }
    CHECK_FALSE(namedPlainly("/a/depth_estimate/image"));
}

TEST_CASE("Floating point under names without a word of depth is played with a warning, as 16 bits are") {
    const TemporaryFolder folder;
    const auto warnings = [&](const std::string& topic, const std::string& frame) {
        BagMaker maker;
        addStream(maker, topic, {.frame = frame, .encoding = "32FC1", .pixels = filled(0.5f)},
                  {.frame = frame});
        return playStreams(folder, maker).warnings();
    };
    const auto found = warnings("/optical_flow", "camera");
    REQUIRE(found.size() == 1);
    mentions(found[0], "/optical_flow: taken as depth by its encoding alone, 32FC1");
    CHECK(warnings("/optical_flow", "camera_depth_optical_frame").empty());
    CHECK(warnings("/cam/depth/image_raw", "camera").empty());
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
