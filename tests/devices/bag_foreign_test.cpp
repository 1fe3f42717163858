// SPDX-License-Identifier: Apache-2.0
// Bags as bridges, scripts and crashed recorders leave them: lenses without size, bytes behind the end.
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

#include <algorithm>
#include <tuple>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE(
    "A lens without width and height counts for the size of its images if it looks through their middle") {
    const TemporaryFolder folder;
    for (const uint32_t binning : {0u, 2u}) {
        InfoMessage info{.width = 0, .height = 0, .binning = binning};
        if (binning == 2) {
            info.k = {14.0, 14.0, 7.0, 5.0};
        }
        BagMaker maker;
        addStream(maker, "/c/depth", depthImage(500), info);
        addStream(maker, "/c/rgb", redImage(), info);
        BagCamera camera = playStreams(folder, maker);
        CHECK(camera.info().depth.width == 8);
        CHECK(camera.info().depth.height == 6);
        CHECK(camera.info().depth.fx == 7.0);
        CHECK(camera.info().registered);
        mentions(camera.streams(), "/c/camera_info without width and height (taken: 8x6)");
        for (int frame = 0; frame < 3; ++frame) {
            CHECK(firstDepth(camera) == 0.5);
        }
        CHECK(camera.skipped() == 0);
    }
    BagMaker half;
    addStream(half, "/c/depth", depthImage(500), {.width = 0});
    mentions(streamRefusal(folder, half), "0x6 where the images of /c/depth have 8x6");
    BagMaker ofOtherSize;
    addStream(ofOtherSize, "/c/depth", depthImage(500),
              {.width = 0, .height = 0, .k = {14.0, 14.0, 7.0, 5.0}});
    mentions(streamRefusal(folder, ofOtherSize),
             "/c/camera_info: width, height: 0, with the principal point (7, 5), as in the middle of images "
             "of 14x10 (allowed: the size of the images of /c/depth, 8x6, whose middle is (3.5, 2.5); "
             "or intrinsics=FILE after the file name)");
}

TEST_CASE("Compressed images of unknown content and empty ones are named apart") {
    const TemporaryFolder folder;
    for (const auto& [bytes, fault] :
         {std::pair(std::string(40, '\1'), "a compressed image without a header that is read"),
          {"", "an empty image"}}) {
        BagMaker maker;
        maker.add("/c/depth", "sensor_msgs/CompressedImage", 1.0,
                  compressedMessage(1.0, "camera", "16UC1; compressedDepth png", bytes));
        mentions(streamRefusal(folder, maker), fault);
    }
}

TEST_CASE("A compressed stream whose red and blue are swapped, or may be, is named once") {
    const TemporaryFolder folder;
    writeColour(folder.path() / "x.png", 8, 6, 0, 0, 255);
    for (const auto& [format, colour, count] :
         {std::tuple("rgb8; png compressed rgb8", 0xff0000ffu, 1),
          std::tuple("rgb8; png compressed ", 0xffff0000u, 1),
          std::tuple("rgb8; png compressed bgr8", 0xffff0000u, 0), std::tuple("png", 0xffff0000u, 0)}) {
        CAPTURE(format);
        BagMaker maker;
        addStream(maker, "/c/depth/image_raw", depthImage(500));
        for (const double t : {1.0, 1.1, 1.2}) {
            maker.add("/c/rgb/camera_info", "sensor_msgs/CameraInfo", t, infoMessage({}));
            maker.add("/c/rgb/image_raw/compressed", "sensor_msgs/CompressedImage", t,
                      compressedMessage(t, "camera", format, folder.read("x.png")));
        }
        BagCamera camera = playStreams(folder, maker);
        while (const auto frame = camera.next()) {
            CHECK((*frame)->colour[0] == colour);
        }
        CHECK(camera.skipped() == 0);
        const std::string said = std::string("/c/rgb/image_raw/compressed: the format '") + format + "'";
        const auto warnings = camera.warnings();
        CHECK(std::ranges::count_if(
                  warnings, [&](const std::string& line) { return line.starts_with(said); }) == count);
    }
}

TEST_CASE("Bytes behind the last record of a closed bag are no part of it") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth", depthImage(500));
    const std::string bag = maker.bag();
    for (const std::string& rest :
         {std::string(512, '\0'), std::string("\n"), std::string("\xff\xff\xff\xff")}) {
        folder.write("a.bag", bag + rest);
        BagCamera camera(folder.path() / "a.bag");
        CHECK(firstDepth(camera) == 0.5);
        CHECK(camera.frameCount() == 3);
    }
}

// A lens without a size, for images of another width and height.
std::string unsizedRefusal(uint32_t width, uint32_t height, double cx, double cy) {
    const TemporaryFolder folder;
    BagMaker maker;
    ImageMessage image = depthImage(500);
    image.width = width;
    image.height = height;
    image.pixels = filled<uint16_t>(500, width * height);
    addStream(maker, "/c/depth", image, {.width = 0, .height = 0, .k = {60.0, 60.0, cx, cy}}, {1.0});
    return streamRefusal(folder, maker);
}

TEST_CASE("A lens without a size is not used for images of another size that cameras have") {
    struct Lens {
        uint32_t width, height;
        double cx, cy;
    };
    // Sizes of RealSense, Kinect and Orbbec cameras, each as width and height / 8 to save time.
    for (const Lens& lens : {Lens{106, 60, 39.9, 29.9}, Lens{80, 60, 40.2, 45.0}, Lens{100, 75, 40.0, 30.0},
                             Lens{160, 90, 53.0, 30.0}, Lens{80, 60, 53.0, 30.0}, Lens{160, 100, 80.0, 40.0},
                             Lens{160, 120, 160.0, 90.0}, Lens{80, 60, 40.0, 22.5}}) {
        CAPTURE(lens.width);
        CAPTURE(lens.cx);
        mentions(unsizedRefusal(lens.width, lens.height, lens.cx, lens.cy), "width, height: 0, with");
    }
    // Real ones of their own size: Kinect, Xtion, D435 at 848x480, Azure Kinect, ZED.
    for (const Lens& lens : {Lens{80, 60, 42.4, 31.3}, Lens{80, 60, 39.3, 30.0}, Lens{106, 60, 52.6, 29.4},
                             Lens{80, 72, 40.0, 41.8}, Lens{160, 90, 79.0, 47.4}}) {
        CAPTURE(lens.width);
        CAPTURE(lens.cx);
        CHECK(unsizedRefusal(lens.width, lens.height, lens.cx, lens.cy).empty());
    }
}

TEST_CASE("Images of one frame and lens are played together where other topics have better names") {
    const TemporaryFolder folder;
    const auto bagOf = [](const std::string& depth, const std::string& colour, bool tf) {
        BagMaker maker;
        for (const std::string& topic :
             {std::string("/wrist/color/image_raw"), std::string("/tof/depth/image_raw")}) {
            const bool isDepth = topic.starts_with("/tof");
            addStream(maker, topic, isDepth ? depthImage(500, "tof_optical") : redImage("wrist_optical"),
                      {.frame = isDepth ? "tof_optical" : "wrist_optical", .k = {6.0, 6.0, 3.0, 2.0}});
        }
        addStream(maker, colour, redImage("body_optical"), {.frame = "body_optical"});
        addStream(maker, depth, depthImage(900, "body_optical"), {.frame = "body_optical"});
        for (const char* child : {"wrist_optical", "tof_optical"}) {
            if (tf) {
                maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0,
                          Out().put(uint32_t{1}).bytes + stampedHeader(1.0, "body_optical") +
                              Out().text(child).bytes + transformMessage(0.3, 0.0, 0.0));
            }
        }
        return maker;
    };
    for (const bool tf : {false, true}) {
        for (const auto& given : {std::pair("/rgbd_camera/depth_image", "/rgbd_camera/image"),
                                  std::pair("/stereo/depth", "/stereo/left/image_rect"),
                                  std::pair("/oak/stereo/image_raw", "/oak/rgb/image_raw")}) {
            const auto &depth = given.first, &colour = given.second;
            CAPTURE(depth);
            BagCamera camera = playStreams(folder, bagOf(depth, colour, tf));
            CHECK(camera.info().registered);
            CHECK(camera.streamOptions() == std::string(",depth=") + depth + ",colour=" + colour);
            CHECK(firstDepth(camera) == doctest::Approx(0.9));
        }
    }
}

TEST_CASE("Of several colours that fit equally the one whose name is most like that of depth is played") {
    const TemporaryFolder folder;
    for (const auto& [other, depth, own] :
         {std::tuple("/rgb_right", "/depth_left", "/rgb_left"),
          std::tuple("/right_rgb", "/left_depth", "/left_rgb"), std::tuple("/rgb_1", "/depth_2", "/rgb_2")}) {
        for (const char* frame : {"sim_camera", ""}) {
            BagMaker maker;
            for (const char* topic : {other, depth, own}) {
                addStream(maker, std::string(topic) + "/image",
                          topic == depth ? depthImage(900, frame) : redImage(frame), {.frame = frame});
            }
            const BagCamera camera = playStreams(folder, maker);
            CHECK(mentions(camera.streamOptions(), std::string(",colour=") + own));
        }
    }
}

TEST_CASE("Images whose step of rows is wrong are played where their bytes are those of rows without gaps") {
    const TemporaryFolder folder;
    for (const uint32_t step : {8u, 96u, 1u}) {
        ImageMessage depth = depthImage(500), colour = redImage();
        depth.step = step;
        colour.step = step == 96u ? 144u : step;
        BagMaker maker;
        addStream(maker, "/c/depth/image_raw", depth);
        addStream(maker, "/c/color/image_raw", colour);
        BagCamera camera = playStreams(folder, maker);
        for (int frame = 0; frame < 3; ++frame) {
            CHECK(firstDepth(camera) == doctest::Approx(0.5));
        }
        CHECK(camera.skipped() == 0);
        const auto warnings = camera.warnings();
        REQUIRE(warnings.size() == 2);
        CHECK(warnings[0] ==
              "/c/depth/image_raw: rows of " + std::to_string(step) + " bytes are stated where they have 16");
    }
    ImageMessage cut = depthImage(500);
    cut.step = 8;
    cut.pixels.resize(90);
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", cut);
    BagCamera camera = playStreams(folder, maker);
    CHECK_THROWS_AS(camera.next(), BadInput);
}

TEST_CASE("Images of 16 bits that nothing names depth are played with a warning, unless they are asked for") {
    const TemporaryFolder folder;
    const auto warned = [&](const char* topic, const char* frame, const SourceOptions& options = {}) {
        BagMaker maker;
        addStream(maker, topic, depthImage(500, frame));
        const auto warnings = playStreams(folder, maker, options).warnings();
        return std::ranges::count_if(warnings, [](const std::string& warning) {
            return warning.find("taken as depth by its encoding alone") != std::string::npos;
        });
    };
    CHECK(warned("/front/image_raw", "camera") == 1);
    CHECK(warned("/front/image_raw", "camera", {.depth = "/front/image_raw"}) == 0);
    CHECK(warned("/front/image_raw", "camera_depth_optical_frame") == 0);
    CHECK(warned("/front/depth", "camera") == 0);
    for (const char* topic : {"/lepton/image_raw", "/stereo/disp", "/front/class_ids", "/front/object_ids"}) {
        BagMaker maker;
        addStream(maker, topic, depthImage(2731));
        mentions(streamRefusal(folder, maker), "whose name is not one of infrared");
    }
}

TEST_CASE("A skew of a lens is named, as no lens here has one") {
    const TemporaryFolder folder;
    for (const double skew : {0.05, -12.0}) {
        BagMaker maker;
        addStream(maker, "/c/depth/image_raw", depthImage(500), {.skew = skew});
        const auto warnings = playStreams(folder, maker).warnings();
        REQUIRE(warnings.size() == (skew < 0.0 ? 1 : 0));
        CHECK((warnings.empty() || mentions(warnings[0], "/c/depth/camera_info: a skew of -12 pixels")));
    }
}
