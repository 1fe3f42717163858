// SPDX-License-Identifier: Apache-2.0
// Topics whose names hold words of depth and of colour: depth that is painted, or that is shown in colour's
// image.
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Painted depth comes first, and has the frame and lens of depth and colour.
BagMaker withPainted(const std::string& depth, const std::string& painted, const std::string& colour) {
    BagMaker maker;
    addStream(maker, painted, {.encoding = "rgb8", .pixels = filledColour(20, 20, 200)});
    addStream(maker, depth, depthImage(500));
    if (!colour.empty()) {
        addStream(maker, colour, redImage());
    }
    return maker;
}

} // namespace

TEST_CASE("Depth that is painted is not colour, whatever word of colour its name ends in") {
    const TemporaryFolder folder;
    for (const auto& given :
         {std::pair<std::string, std::string>{"/blaze/depth_map", "/blaze/depth_map_color"},
          {"/camera/depth/image_raw", "/camera/depth/image_color"},
          {"/camera/depth", "/camera/depth_color"},
          {"/camera/depth", "/camera/depth_rgb"},
          {"/camera/depth/image_raw", "/camera/depth/color"},
          {"/camera/depth", "/camera/depth_color_map/image"},
          {"/oak/stereo/image_raw", "/oak/stereo/depth_color"},
          {"/camera/depth/image_raw", "/camera/depth/image_rgb8"},
          {"/camera/depth/image_raw", "/camera/depth/jet_color"},
          {"/cam/depthImage", "/cam/depthColored"},
          {"/cam/depthImage", "/cam/depthColor"},
          {"/camera/depth/image_raw", "/camera/colormap/image"},
          {"/camera/depth/image_raw", "/camera/jet/image"}}) {
        const auto &depth = given.first, &painted = given.second;
        CAPTURE(painted);
        BagCamera alone = playStreams(folder, withPainted(depth, painted, ""));
        CHECK_FALSE(alone.info().hasColour);
        mentions(alone.whyNoColour(), "named as painted depth; colour=" + painted + " plays it");
        BagCamera both = playStreams(folder, withPainted(depth, painted, "/camera/image_raw"));
        CHECK(both.streamOptions() == ",depth=" + depth + ",colour=/camera/image_raw");
        CHECK(playStreams(folder, withPainted(depth, painted, ""), {.colour = painted}).info().hasColour);
    }
}

TEST_CASE("Images of depth's encoding are depth under a name that holds words of depth and of colour") {
    const TemporaryFolder folder;
    for (const char* topic : {"/camera/depth_in_color/image_raw", "/camera/depth_rgb_aligned/image_raw",
                              "/camera/depth_color_frame/image", "/k4a/depth_in_rgb/image_raw",
                              "/camera/depth_aligned_color/image_raw", "/camera/depth/image_raw_rgb",
                              "/camera/depth_aligned_to_color_and_infra1/image_raw"}) {
        CAPTURE(topic);
        BagMaker maker;
        addStream(maker, topic, depthImage(500));
        addStream(maker, "/camera/color/image_raw", redImage());
        CHECK(playStreams(folder, maker).streamOptions() ==
              std::string(",depth=") + topic + ",colour=/camera/color/image_raw");
    }
}

TEST_CASE("A camera that is named depth has colour") {
    const TemporaryFolder folder;
    for (const auto& given :
         {std::pair<std::string, std::string>{"/depth/depth/image_raw", "/depth/color/image_raw"},
          {"/depth/depth", "/depth/color"},
          {"/depth/image_depth", "/depth/image_color"},
          {"/depth_camera/depth", "/depth_camera/color"},
          {"/depth_camera/depth/image_raw", "/depth_camera/image_raw"},
          {"/depthCamera/depth/image", "/depthCamera/image"},
          {"/my_depth/image", "/my_depth/color"},
          {"/depth_color_camera/depth", "/depth_color_camera/image_color"},
          {"/camera/depth/image_raw", "/camera/rgb_to_depth/image_raw"},
          {"/jet/depth/image_raw", "/jet/image_raw"},
          {"/camera/depth_to_rgb/image_raw", "/camera/rgb/image_raw"}}) {
        const auto &depth = given.first, &colour = given.second;
        CAPTURE(colour);
        CHECK(playStreams(folder, withPainted(depth, colour, "")).streamOptions() ==
              ",depth=" + depth + ",colour=" + colour);
    }
}
