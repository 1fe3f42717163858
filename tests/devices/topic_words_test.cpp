// SPDX-License-Identifier: Apache-2.0
// Words in the names of topics: camel case, plurals and further names of depth and of brightness.
#include "devices/bag/stream_names.h"
#include "tests/devices/played_bag.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Where `other` comes first, and has depth's frame and lens, too.
std::string chosenDepth(const std::string& other, const std::string& depth) {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, other, depthImage(2345));
    addStream(maker, depth, depthImage(500));
    addStream(maker, "/cam/colorImage", redImage());
    return playStreams(folder, maker, {.colour = "/cam/colorImage"}).streamOptions();
}

} // namespace

TEST_CASE("Infrared, amplitude and confidence are not depth in names in camel case and plurals either") {
    for (const auto& given : {std::pair<std::string, std::string>{"/cam/irImage", "/cam/depthImage"},
                              {"/cam/imageIR", "/cam/imageDepth"},
                              {"/cam/IRImage", "/cam/DepthImage"},
                              {"/cam/infraredImage", "/cam/depthImage"},
                              {"/cam/confidenceMap", "/cam/depthMap"},
                              {"/tof/amplitudes", "/tof/distances"},
                              {"/tof/intensities", "/tof/ranges"},
                              {"/tof/brightness", "/tof/image"},
                              {"/cam0/ab_image", "/cam0/z_image"},
                              {"/tof/conf", "/tof/image"}}) {
        const auto &other = given.first, &depth = given.second;
        CAPTURE(other);
        CHECK(chosenDepth(other, depth) == ",depth=" + depth + ",colour=/cam/colorImage");
    }
    CHECK(chosenDepth("/cam/distance_image", "/cam/depth_image") ==
          ",depth=/cam/depth_image,colour=/cam/colorImage"); // distances may be along the rays
    CHECK(namedRole("/ab/image_raw") == NamedRole::None);    // names of robots
    CHECK(namedRole("/z/image_raw") == NamedRole::None);
    CHECK(namedRole("/lens/image_raw") == NamedRole::None);
    CHECK(namedRole("/front/distance_to_image_plane") == NamedRole::None); // of the same kind as any depth
}

TEST_CASE("Words in camel case say that images are rectified, registered or of a right camera") {
    for (const char* topic : {"/cam/depthRect", "/cam/rectImage", "/cam/imageRectified"}) {
        CAPTURE(topic);
        CHECK(namedRectified(topic));
    }
    CHECK_FALSE(namedRectified("/cam/directImage"));
    CHECK(namedRegistered("/cam/depthRegistered"));
    CHECK(namedRegistered("/cam/alignedDepth/image"));
    CHECK(namedRight("/stereo/rightImageRect"));
    CHECK_FALSE(namedRight("/stereo/brightImage"));
    CHECK(namedDepthImage("/cam/depthColored"));
    CHECK_FALSE(namedDepthImage("/depthCamera/image"));
}

TEST_CASE("A topic of depth in camel case plays images of mono16 as depth") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/cam/depthImage", depthImage(500, "camera", "mono16"));
    BagCamera camera = playStreams(folder, maker);
    CHECK(firstDepth(camera) == doctest::Approx(0.5));
}
