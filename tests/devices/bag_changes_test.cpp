// SPDX-License-Identifier: Apache-2.0
// Bags whose lens, unit or stamps change, and streams that only look like depth or colour.
#include "engine/types/colour_copy.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Depths [m] of all frames that are played.
std::vector<double> depthsOf(BagCamera& camera) {
    std::vector<double> depths;
    while (const auto frame = camera.next()) {
        depths.push_back((*frame)->depth[0] * camera.info().metresPerUnit);
    }
    return depths;
}

// Three depth images of 0.5, 0.6 and 0.7 m, and red, blue and blue ones, all with these stamps.
BagMaker stampedBag(const std::array<double, 3>& stamps) {
    BagMaker maker;
    for (const char* topic : {"/c/depth_registered/camera_info", "/c/rgb/camera_info"}) {
        maker.add(topic, "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    }
    for (size_t i = 0; i < stamps.size(); ++i) {
        const double t = 1.0 + 0.1 * static_cast<double>(i);
        const auto depth = depthImage(static_cast<uint16_t>(500 + 100 * i));
        ImageMessage colour = redImage();
        colour.pixels = i == 0 ? colour.pixels : filledColour(10, 10, 200);
        maker.add("/c/depth_registered/image_raw", "sensor_msgs/Image", t, imageMessage(stamps[i], depth));
        maker.add("/c/rgb/image_raw", "sensor_msgs/Image", t, imageMessage(stamps[i], colour));
    }
    return maker;
}

} // namespace

TEST_CASE("Frames of a bag after its lens has changed are skipped and counted, not played with the first") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", depthImage(500));
    CHECK(playStreams(folder, maker).info().depth.fx == 7.0);
    InfoMessage other;
    other.k = {14.0, 14.0, 3.5, 2.5};
    maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.05, infoMessage(other));
    BagCamera camera = playStreams(folder, maker);
    CHECK(depthsOf(camera).size() == 1);
    CHECK(camera.skipped() == 2);
}

TEST_CASE(
    "A lens that is computed anew for each image, and is the same to a tenth of a pixel, is no other one") {
    const TemporaryFolder folder;
    for (const auto& [step, played] : {std::pair(0.001, 3u), {0.5, 1u}}) {
        BagMaker maker;
        addStream(maker, "/c/depth/image_raw", depthImage(500));
        for (const int i : {1, 2}) {
            const double fx = 7.0 + step * i;
            maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.0 + 0.09 * i,
                      infoMessage({.distortion = {1e-5 * i, 0, 0, 0, 0}, .k = {fx, fx, 3.5, 2.5}}));
        }
        BagCamera camera = playStreams(folder, maker);
        CHECK(depthsOf(camera).size() == played);
    }
}

TEST_CASE(
    "Images of another camera on the topics of the first one are skipped and named, not played as its own") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", depthImage(500, "left"));
    addStream(maker, "/c/color/image_raw", redImage("left"));
    for (const double t : {1.3, 1.4}) {
        const bool depth = t < 1.35;
        maker.add("/c/depth/image_raw", "sensor_msgs/Image", t,
                  imageMessage(t, depthImage(depth ? 900 : 600, depth ? "right" : "left")));
        maker.add("/c/color/image_raw", "sensor_msgs/Image", t,
                  imageMessage(t, redImage(depth ? "left" : "right")));
    }
    maker.add("/c/depth/image_raw", "sensor_msgs/Image", 1.5, imageMessage(1.5, depthImage(700, "")));
    maker.add("/c/color/image_raw", "sensor_msgs/Image", 1.5, imageMessage(1.5, redImage("")));
    BagCamera camera = playStreams(folder, maker);
    const std::vector<double> played = depthsOf(camera);
    CHECK(played.size() == 4);
    CHECK(played.back() == doctest::Approx(0.7)); // headers may name no frame
    CHECK(camera.skipped() == 2);
    BagCamera late = playStreams(folder, maker, {.start = 0.25, .duration = 0.1});
    CHECK_THROWS_WITH_AS(
        late.next(),
        doctest::Contains("/c/depth/image_raw: its frame is 'right', that of the first one 'left'"),
        BadInput);
}

TEST_CASE(
    "A bag plays without its first images and lenses where these are empty, damaged or of another size") {
    const TemporaryFolder folder;
    const std::string whole = imageMessage(1.0, depthImage(500)), lens = infoMessage({});
    const std::string empty = imageMessage(1.0, {.height = 0, .step = 1}),
                      large =
                          imageMessage(1.0, {.width = 16, .height = 12, .pixels = filled(uint16_t{5}, 192)});
    InfoMessage unset;
    unset.k = {};
    const std::string none = infoMessage(unset);
    for (const auto& [image, info] : {std::pair(empty, lens),
                                      {whole.substr(0, 30), lens},
                                      {large, lens},
                                      {whole, none},
                                      {whole, lens.substr(0, 60)},
                                      {empty, none}}) {
        BagMaker maker;
        for (int i = 0; i < 5; ++i) {
            const double t = 1.0 + 0.1 * i;
            maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", t - 0.01, i < 2 ? info : lens);
            maker.add("/c/depth/image_raw", "sensor_msgs/Image", t,
                      i < 2 ? image : imageMessage(t, depthImage(500)));
        }
        BagCamera camera = playStreams(folder, maker);
        CHECK(depthsOf(camera) == std::vector<double>(3, 0.5));
        CHECK(camera.skipped() == 2);
    }
}

TEST_CASE("No frame of a bag is played while the lens that applies to it is damaged") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", depthImage(500), {}, {1.0, 1.1, 1.2, 1.3});
    maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.05, infoMessage({}).substr(0, 60));
    maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.25, infoMessage({}));
    BagCamera camera = playStreams(folder, maker);
    CHECK(depthsOf(camera).size() == 2);
    CHECK(camera.skipped() == 2);
}

TEST_CASE(
    "Frames of an SDK bag after its depth unit has changed are skipped, and a missing unit is reported") {
    const TemporaryFolder folder;
    const std::string sensor = "/device_0/sensor_0/", option = sensor + "option/Depth_Units/value";
    BagMaker maker;
    maker.add(sensor + "Depth_0/info/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    for (const double t : {1.0, 1.1, 1.2}) {
        maker.add(sensor + "Depth_0/image/data", "sensor_msgs/Image", t,
                  imageMessage(t, depthImage(500, "0", "mono16")));
    }
    BagCamera without = playStreams(folder, maker);
    REQUIRE(without.warnings().size() == 1);
    CHECK(mentions(without.warnings()[0], "Depth_Units"));
    CHECK(depthsOf(without).size() == 3);
    CHECK(playStreams(folder, maker, {.scale = 0.0001}).warnings().empty());
    maker.add(option, "std_msgs/Float32", 0.9, raw(0.001f));
    maker.add(option, "std_msgs/Float32", 1.15, raw(0.0001f));
    BagCamera camera = playStreams(folder, maker);
    CHECK(camera.warnings().empty());
    CHECK(depthsOf(camera).size() == 2);
    CHECK(camera.skipped() == 1);
}

TEST_CASE("Stamps that do not rise are no times: images are paired by the time of recording") {
    const TemporaryFolder folder;
    for (const auto& stamps : {std::array{1.0, 1.0, 1.0}, std::array{0.0155, 0.0154, 0.0153}}) {
        BagCamera camera = playStreams(folder, stampedBag(stamps));
        const auto first = camera.next(), second = camera.next();
        REQUIRE(first);
        REQUIRE(second);
        CHECK(coloursOf(**first)[0] == kRedPixel);
        CHECK(coloursOf(**second)[0] != kRedPixel);
        CHECK((*second)->captureTime - (*first)->captureTime == doctest::Approx(0.1));
    }
    BagCamera once = playStreams(folder, stampedBag({1.0, 1.2, 1.1})); // one fault, not most
    CHECK(depthsOf(once).size() == 2);
}

TEST_CASE(
    "After the clock of a camera is set back, a bag plays on with times that rise, again after a seek") {
    const TemporaryFolder folder;
    BagMaker maker;
    for (const char* topic : {"/c/depth_registered/camera_info", "/c/rgb/camera_info"}) {
        maker.add(topic, "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    }
    constexpr uint32_t kAll = 40, kSetBack = 34;
    for (uint32_t i = 0; i < kAll; ++i) {
        const double recorded = 1.0 + 0.1 * i, stamp = 0.1 * (i < kSetBack ? 10'000 + i : i);
        const std::string depth = imageMessage(stamp, depthImage(static_cast<uint16_t>(500 + i)));
        maker.add("/c/depth_registered/image_raw", "sensor_msgs/Image", recorded,
                  i == kSetBack + 2 ? depth.substr(0, 9) : depth);
        maker.add("/c/rgb/image_raw", "sensor_msgs/Image", recorded, imageMessage(stamp, redImage()));
    }
    BagCamera camera = playStreams(folder, maker);
    for (const uint32_t passes : {1u, 2u}) {
        REQUIRE(camera.seek(0));
        double last = 0.0;
        uint32_t played = 0;
        for (; const auto frame = camera.next(); ++played) {
            CHECK(std::abs((*frame)->captureTime - (1000.0 + 0.1 * (*frame)->index)) < 1e-6);
            CHECK((*frame)->captureTime > last);
            last = (*frame)->captureTime;
        }
        CHECK(played == kAll - 1); // one is damaged
        CHECK(camera.skipped() == passes);
    }
    REQUIRE(camera.warnings().size() == 1);
    CHECK(camera.warnings()[0].find("goes back by 999.900000 s at frame 34: times continue") !=
          std::string::npos);
}

TEST_CASE("A 16-bit grey image is depth only under a name of depth, or when it is asked for") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/boson/image_raw", depthImage(3000, "camera", "mono16"));
    CHECK(mentions(streamRefusal(folder, maker), "/boson/image_raw (mono16)"));
    BagCamera asked = playStreams(folder, maker, {.depth = "/boson/image_raw"});
    CHECK(firstDepth(asked) == doctest::Approx(3.0));
    BagMaker named;
    addStream(named, "/zed/range/image", depthImage(700, "camera", "mono16"));
    BagCamera range = playStreams(folder, named);
    CHECK(firstDepth(range) == doctest::Approx(0.7));
}

TEST_CASE("Encodings of depth are read in upper and lower case") {
    const TemporaryFolder folder;
    for (const char* encoding : {"16uc1", "Z16", "MONO16"}) {
        BagMaker maker;
        addStream(maker, "/c/depth/image", depthImage(500, "camera", encoding));
        BagCamera camera = playStreams(folder, maker);
        CHECK_MESSAGE(firstDepth(camera) == doctest::Approx(0.5), encoding);
        BagMaker grey;
        addStream(grey, "/c/image", depthImage(500, "camera", encoding));
        CHECK(streamRefusal(folder, grey).empty() == (std::string(encoding) != "MONO16"));
    }
    BagMaker metres;
    addStream(metres, "/c/depth/image", {.encoding = "32fc1", .pixels = filled(0.5f)});
    BagCamera camera = playStreams(folder, metres);
    CHECK(firstDepth(camera) == doctest::Approx(0.5));
}

TEST_CASE("Painted depth is not taken for colour unless it is asked for, and is named") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth_registered/image_raw", depthImage(500));
    addStream(maker, "/c/depth_registered/image_colored", redImage());
    BagCamera camera = playStreams(folder, maker);
    CHECK_FALSE(camera.info().hasColour);
    CHECK(mentions(camera.whyNoColour(), "/c/depth_registered/image_colored (rgb8, named as painted depth"));
    CHECK(playStreams(folder, maker, {.colour = "/c/depth_registered/image_colored"}).info().hasColour);
    BagMaker real; // as Gazebo names the colour of a depth camera
    addStream(real, "/depth_camera/depth/image_raw", depthImage(500));
    addStream(real, "/depth_camera/image_raw", redImage());
    CHECK(playStreams(folder, real).info().hasColour);
}

TEST_CASE("Depth registered to a resized colour image is played with it, by the same rays") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth_registered/image_raw", depthImage(500));
    ImageMessage colour{
        .encoding = "rgb8", .width = 16, .height = 12, .pixels = filledColour(200, 10, 10, 192)};
    InfoMessage lens{.width = 16, .height = 12};
    lens.k = {14.0, 14.0, 7.5, 5.5};
    addStream(maker, "/c/rgb/image_raw", colour, lens);
    BagCamera camera = playStreams(folder, maker);
    CHECK(camera.info().colour.width == 16);
    CHECK(camera.info().colourTdepth.position == dvec3(0.0));
}

TEST_CASE("Files without images name their topics, and video that is not read is named as such") {
    const TemporaryFolder folder;
    BagMaker maker;
    maker.add("/stereo/disparity", "stereo_msgs/DisparityImage", 1.0, std::string(40, '\0'));
    CHECK(mentions(streamRefusal(folder, maker),
                   "no images but /stereo/disparity (stereo_msgs/DisparityImage)"));
    addStream(maker, "/c/depth/image_raw", depthImage(500));
    maker.add("/c/rgb/theora", "theora_image_transport/Packet", 1.0, std::string(40, '\0'));
    CHECK(
        mentions(playStreams(folder, maker).whyNoColour(), "/c/rgb/theora (theora_image_transport/Packet)"));
}

TEST_CASE("Float depth in millimetres keeps its values, so that what is wrong can be said") {
    const TemporaryFolder folder;
    BagMaker maker;
    ImageMessage image{.encoding = "32FC1", .pixels = filled(500.0f)};
    addStream(maker, "/c/depth/image_raw", image);
    BagCamera camera = playStreams(folder, maker, {.farthest = 10.0});
    CHECK(firstDepth(camera) == doctest::Approx(500.0).epsilon(1e-3));
    REQUIRE(camera.warnings().size() == 1);
    CHECK(mentions(camera.warnings()[0], "scale=0.001"));
    BagCamera scaled = playStreams(folder, maker, {.scale = 0.001, .farthest = 10.0});
    CHECK(firstDepth(scaled) == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(mentions(streamRefusal(folder, maker, {.scale = 1000.0}), "scale: 1000"));
}

TEST_CASE("The first bytes of a file of messages decide its kind, not its name") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", depthImage(500));
    folder.write("a.mcap", maker.bag());
    BagCamera camera(folder.path() / "a.mcap");
    CHECK(firstDepth(camera) == doctest::Approx(0.5));
}
