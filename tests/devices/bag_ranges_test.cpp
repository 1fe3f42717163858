// SPDX-License-Identifier: Apache-2.0
// Bags of simulators, whose depth may be ranges along the rays.
#include "tests/devices/played_bag.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

BagMaker simulatorBag(const std::vector<std::string>& depths) {
    BagMaker maker;
    uint16_t value = 900;
    for (const std::string& depth : depths) {
        addStream(maker, depth, depthImage(value));
        value += 100;
    }
    return maker;
}

bool warnsOfRanges(const BagCamera& camera) {
    const auto said = camera.warnings();
    return std::any_of(said.begin(), said.end(), [](const std::string& line) {
        return line.find("ranges along the rays, played as depth") != std::string::npos;
    });
}

} // namespace

TEST_CASE("A bag with ranges and depth of the same view plays depth, in either order") {
    const TemporaryFolder folder;
    const std::string range = "/drone/front/DepthPerspective", depth = "/drone/front/DepthPlanar";
    for (const auto& topics : {std::vector{range, depth}, std::vector{depth, range}}) {
        BagCamera camera = playStreams(folder, simulatorBag(topics));
        CHECK(camera.streamOptions().find(depth) != std::string::npos);
        CHECK_FALSE(warnsOfRanges(camera));
    }
}

TEST_CASE("Ranges in a bag have a warning, and depth_is in the file of the lens makes depth of them") {
    const TemporaryFolder folder;
    for (const char* topic :
         {"/distance_to_camera", "/drone/front/DepthPerspective", "/tof/radial_distance/image",
          "/sim/euclideanDepth", "/ifm3d/camera/distance", "/tof/rangeImage"}) {
        CAPTURE(topic);
        BagCamera plain = playStreams(folder, simulatorBag({topic}));
        CHECK(warnsOfRanges(plain));
        CHECK(firstDepth(plain) == doctest::Approx(0.9));
        folder.write(
            "lens.json",
            R"({"width": 8, "height": 6, "fx": 7, "fy": 7, "cx": 3.5, "cy": 2.5, "depth_is": "range"})");
        BagCamera camera = playStreams(folder, simulatorBag({topic}),
                                       {.colour = "none", .intrinsics = folder.path() / "lens.json"});
        CHECK_FALSE(warnsOfRanges(camera));
        const double x = 3.5 / 7.0, y = 2.5 / 7.0; // of the ray of the first pixel
        CHECK(firstDepth(camera) == doctest::Approx(0.9 / std::sqrt(1.0 + x * x + y * y)).epsilon(0.001));
    }
}

TEST_CASE("Depth of a plane has no warning of ranges, whatever else its name contains") {
    const TemporaryFolder folder;
    for (const char* topic :
         {"/front/distance_to_image_plane", "/cam/depth_range/image", "/ORANGE_CAM/image"}) {
        CAPTURE(topic);
        CHECK_FALSE(warnsOfRanges(playStreams(folder, simulatorBag({topic}))));
    }
}
