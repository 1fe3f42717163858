// SPDX-License-Identifier: Apache-2.0
// Which streams of a bag are played, with which lens, unit and pairs.
#include "engine/types/colour_copy.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

#include <limits>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("The depth unit of a RealSense SDK bag is found under every name that the SDK has written") {
    const TemporaryFolder folder;
    for (const char* name : {"Depth Units", "Depth_Units", "depth_units", "Depth-Units"}) {
        BagMaker maker;
        maker.add(std::string("/device_0/sensor_0/option/") + name + "/value", "std_msgs/Float32", 1.0,
                  raw(0.0001f));
        maker.add("/device_0/sensor_0/Depth_0/info/camera_info", "sensor_msgs/CameraInfo", 1.0,
                  infoMessage({}));
        maker.add("/device_0/sensor_0/Depth_0/image/data", "sensor_msgs/Image", 1.0,
                  imageMessage(1.0, depthImage(3000, "0", "mono16")));
        BagCamera camera = playStreams(folder, maker);
        CHECK(camera.info().metresPerUnit == doctest::Approx(0.0001).epsilon(1e-12));
        CHECK(firstDepth(camera) == doctest::Approx(0.3));
    }
    BagMaker absurd;
    absurd.add("/device_0/sensor_0/option/Depth_Units/value", "std_msgs/Float32", 1.0, raw(1000.0f));
    absurd.add("/device_0/sensor_0/Depth_0/info/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    absurd.add("/device_0/sensor_0/Depth_0/image/data", "sensor_msgs/Image", 1.0,
               imageMessage(1.0, depthImage(3000, "0", "mono16")));
    CHECK(streamRefusal(folder, absurd).find("metres per unit") != std::string::npos);
    CHECK(playStreams(folder, absurd, {.scale = 0.00025}).info().metresPerUnit == 0.00025);
}

TEST_CASE("Infrared, confidence and other brightness images are never taken for depth") {
    const TemporaryFolder folder;
    for (const char* topic :
         {"/kinect2/sd/image_ir_rect", "/camera/ir/image", "/camera/infra1/image_rect_raw",
          "/tof/amplitude/image", "/cam/depth/confidence/image", "/royale/gray_image",
          "/device_0/sensor_0/Infrared_1/image/data"}) {
        BagMaker maker;
        addStream(maker, topic, depthImage(700, "camera", "mono16"));
        CHECK(streamRefusal(folder, maker).find(topic) != std::string::npos); // alone it is refused
        addStream(maker, "/camera/depth_registered/image_raw", depthImage(500));
        addStream(maker, "/camera/rgb/image_color", redImage());
        BagCamera camera = playStreams(folder, maker);
        CHECK_MESSAGE(firstDepth(camera) == doctest::Approx(0.5), topic);
        CHECK(camera.streams().find(topic) != std::string::npos); // said as not used
    }
}

TEST_CASE("Depth that is registered to colour is played before depth that is not, in any order of topics") {
    const TemporaryFolder folder;
    const InfoMessage own{.frame = "depth", .k = {6.0, 6.0, 3.0, 2.0}};
    for (const bool rawFirst : {true, false}) {
        BagMaker maker;
        if (rawFirst) {
            addStream(maker, "/camera/depth/image_rect_raw", depthImage(900, "depth"), own);
        }
        addStream(maker, "/camera/infra1/image_rect_raw",
                  {.frame = "depth", .encoding = "mono8", .pixels = filled(uint8_t{90})}, own);
        addStream(maker, "/camera/aligned_depth_to_color/image_raw", depthImage(500, "color"));
        addStream(maker, "/camera/color/image_raw", redImage("color"));
        if (!rawFirst) {
            addStream(maker, "/camera/depth/image_rect_raw", depthImage(900, "depth"), own);
        }
        BagCamera camera = playStreams(folder, maker);
        CHECK(camera.info().registered);
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[0] == 500);
        CHECK(coloursOf(**frame)[0] == kRedPixel);
    }
}

TEST_CASE("Of several cameras, depth and colour of the same one are played, or those that are asked for") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/front/rgb/image_raw", redImage("front"));
    addStream(maker, "/rear/depth_registered/image_raw", depthImage(800, "rear"));
    addStream(maker, "/front/depth_registered/image_raw", depthImage(500, "front"));
    addStream(maker, "/rear/rgb/image_raw",
              {.frame = "rear", .encoding = "rgb8", .pixels = filledColour(1, 2, 3)});
    BagCamera any = playStreams(folder, maker);
    const auto frame = any.next();
    REQUIRE(frame);
    CHECK(((*frame)->depth[0] == 500) == (coloursOf(**frame)[0] == kRedPixel));
    BagCamera asked = playStreams(folder, maker, {.depth = "/front/depth_registered/image_raw"});
    const auto other = asked.next();
    REQUIRE(other);
    CHECK((*other)->depth[0] == 500);
    CHECK(coloursOf(**other)[0] == kRedPixel);
    CHECK(streamRefusal(folder, maker, {.depth = "/nowhere"}).find("/nowhere") != std::string::npos);
    CHECK(streamRefusal(folder, maker, {.colour = "/nowhere"}).find("/nowhere") != std::string::npos);
    CHECK_FALSE(playStreams(folder, maker, {.colour = "none"}).info().hasColour);
}

TEST_CASE("Rectified images are projected by P without distortion, others by K with it") {
    const TemporaryFolder folder;
    InfoMessage bent{.distortion = {0.09, -0.28, 0.001, -0.001, 0.12}, .p = {6.5, 6.6, 3.1, 2.2}};
    for (const char* name : {"image_depth_rect", "image_rect_raw", "image_rect", "image_raw"}) {
        BagMaker maker;
        addStream(maker, std::string("/kinect2/depth/") + name, depthImage(1000), bent);
        const BagCamera camera = playStreams(folder, maker);
        const bool rectified = std::string(name) != "image_raw";
        CHECK(camera.info().depth.distorted() != rectified);
        CHECK(camera.info().depth.fx == (rectified ? 6.5 : 7.0));
        CHECK(camera.info().depth.cy == (rectified ? 2.2 : 2.5));
    }
    bent.p = {};
    BagMaker maker;
    addStream(maker, "/cam/depth/image_rect", depthImage(1000), bent);
    CHECK(playStreams(folder, maker).info().depth.fx == 7.0); // no P: K, still without distortion
    CHECK_FALSE(playStreams(folder, maker).info().depth.distorted());
}

TEST_CASE("Rectified images need neither distortion that is read nor K, others say what is wrong") {
    const TemporaryFolder folder;
    const InfoMessage plain{.p = {6.5, 6.6, 3.1, 2.2}};
    InfoMessage thinPrism = plain, twoSpheres = plain, unknown = plain, withoutK = plain;
    thinPrism.model = "rational_polynomial";
    thinPrism.distortion = {1, -2, 0, 0, 0.5, 0.1, 0.2, 0.3, 0.001, 0.002, 0.001, 0.002, 0, 0};
    twoSpheres.model = "double_sphere";
    twoSpheres.distortion = {0.1, 0.2};
    unknown.distortion.assign(5, std::numeric_limits<double>::quiet_NaN());
    withoutK.k = {};
    for (const auto& [info, fault] : {std::pair(thinPrism, "no coefficients after k6"),
                                      {twoSpheres, "'double_sphere' with 2"},
                                      {unknown, "finite coefficients"},
                                      {withoutK, "without a focal length"}}) {
        BagMaker maker;
        addStream(maker, "/c/depth/image_rect", depthImage(500), info);
        addStream(maker, "/c/rgb/image_rect", redImage(), info);
        maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.1, infoMessage(info));
        BagCamera camera = playStreams(folder, maker);
        CHECK(camera.info().registered);
        CHECK(camera.info().depth.fx == 6.5);
        CHECK(firstDepth(camera) == doctest::Approx(0.5));
        CHECK(camera.next()); // its lens is no other one
        BagMaker bent;
        addStream(bent, "/c/depth/image_raw", depthImage(500), info);
        CHECK(mentions(streamRefusal(folder, bent), fault));
    }
}

TEST_CASE("Binning and region of interest change the lens as image_geometry does") {
    const TemporaryFolder folder;
    BagMaker maker;
    const InfoMessage info{
        .width = 32, .height = 24, .k = {28.0, 28.0, 15.0, 11.0}, .binning = 2, .roi = {8, 6, 12, 16}};
    addStream(maker, "/cam/depth/image_raw", depthImage(1000), info);
    const Intrinsics lens = playStreams(folder, maker).info().depth;
    CHECK(lens.width == 8);
    CHECK(lens.height == 6);
    CHECK(lens.fx == 14.0);
    CHECK(lens.cx == doctest::Approx((15.0 - 8.0) / 2));
    CHECK(lens.cy == doctest::Approx((11.0 - 6.0) / 2));
    BagMaker other;
    addStream(other, "/cam/depth/image_raw", depthImage(1000), {.width = 16, .height = 12});
    CHECK(streamRefusal(folder, other).find("16x12") != std::string::npos); // never a lens of another size
}

TEST_CASE("Images are paired by the stamps of their headers, however late they were recorded") {
    const TemporaryFolder folder;
    BagMaker maker;
    maker.add("/c/depth_registered/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    maker.add("/c/rgb/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    for (int i = 0; i < 3; ++i) {
        const double t = 1.0 + 0.1 * i;
        maker.add("/c/depth_registered/image_raw", "sensor_msgs/Image", t,
                  imageMessage(t, depthImage(static_cast<uint16_t>(500 + 100 * i))));
        maker.add(
            "/c/rgb/image_raw", "sensor_msgs/Image", t + 0.1,
            imageMessage(t, {.encoding = "rgb8", .pixels = filledColour(static_cast<uint8_t>(i), 0, 0)}));
    }
    BagCamera camera = playStreams(folder, maker);
    for (uint32_t i = 0; i < 3; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((coloursOf(**frame)[0] & 0xff) == i);
    }
    CHECK(camera.skipped() == 0);
}

TEST_CASE("Streams with different clocks, or headers without stamps, are paired by the time of recording") {
    const TemporaryFolder folder;
    for (const double colourClock : {5000.0, 0.0}) {
        BagMaker maker;
        maker.add("/c/depth_registered/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
        maker.add("/c/rgb/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
        for (int i = 0; i < 3; ++i) {
            const double t = 100.0 + 0.1 * i;
            maker.add("/c/depth_registered/image_raw", "sensor_msgs/Image", t,
                      imageMessage(t, depthImage(500)));
            maker.add(
                "/c/rgb/image_raw", "sensor_msgs/Image", t + 0.01,
                imageMessage(colourClock > 0.0 ? colourClock + 0.1 * i : 0.0,
                             {.encoding = "rgb8", .pixels = filledColour(static_cast<uint8_t>(i), 0, 0)}));
        }
        BagCamera camera = playStreams(folder, maker);
        for (uint32_t i = 0; i < 3; ++i) {
            const auto frame = camera.next();
            REQUIRE(frame);
            CHECK((coloursOf(**frame)[0] & 0xff) == i);
        }
    }
}

TEST_CASE("A depth image of a bag whose stamp goes back is skipped and counted") {
    const TemporaryFolder folder;
    BagMaker maker;
    maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    double recorded = 1.0;
    for (const double t : {1.0, 1.033, 1.1, 1.067, 1.133}) {
        maker.add("/c/depth/image_raw", "sensor_msgs/Image", recorded += 0.033,
                  imageMessage(t, depthImage(500)));
    }
    BagCamera camera = playStreams(folder, maker);
    double last = 0.0;
    uint32_t used = 0;
    while (const auto frame = camera.next()) {
        CHECK((*frame)->captureTime > last);
        last = (*frame)->captureTime;
        ++used;
    }
    CHECK(used == 4);
    CHECK(camera.skipped() == 1);
}

TEST_CASE("Depth in metres keeps a tenth of a millimetre, and its holes") {
    const TemporaryFolder folder;
    std::string pixels;
    for (int i = 0; i < 48; ++i) {
        const float hole[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -1.0f};
        pixels += raw(i < 3 ? hole[i] : 0.3124f);
    }
    BagMaker maker;
    addStream(maker, "/c/depth/image", {.encoding = "32FC1", .pixels = pixels});
    BagCamera camera = playStreams(folder, maker);
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] == 0);
    CHECK((*frame)->depth[1] == 0);
    CHECK((*frame)->depth[2] == 0);
    CHECK((*frame)->depth[3] * camera.info().metresPerUnit == doctest::Approx(0.3124).epsilon(1e-6));
    BagMaker far;
    addStream(far, "/c/depth/image", {.encoding = "32FC1", .pixels = filled(40.0f)});
    BagCamera wide = playStreams(folder, far);
    CHECK(firstDepth(wide) == doctest::Approx(40.0).epsilon(1e-4)); // a coarser unit, not a hole
    BagMaker millimetres;
    addStream(millimetres, "/c/depth/image", {.encoding = "32FC1", .pixels = filled(312.4f)});
    BagCamera scaled = playStreams(folder, millimetres, {.scale = 0.001});
    CHECK(firstDepth(scaled) == doctest::Approx(0.3124).epsilon(1e-3));
}

TEST_CASE("Start and duration cut a bag, and a scene of frames can be sought") {
    const TemporaryFolder folder;
    BagMaker maker;
    std::vector<double> times;
    for (int i = 0; i < 10; ++i) {
        times.push_back(1.0 + 0.1 * i);
    }
    addStream(maker, "/c/depth/image_raw", depthImage(500), {}, times);
    BagCamera camera = playStreams(folder, maker, {.start = 0.25, .duration = 0.3});
    uint32_t used = 0;
    while (const auto frame = camera.next()) {
        CHECK((*frame)->index == 3 + used++);
    }
    CHECK(used == 3);
    CHECK(camera.seek(4));
    CHECK((*camera.next())->index == 4);
    CHECK(streamRefusal(folder, maker, {.start = 5.0}).find("start") != std::string::npos);
}

TEST_CASE("Images that cannot be read are named with their fault where a bag has no depth") {
    const TemporaryFolder folder;
    BagMaker maker;
    maker.add("/c/depth/image_raw", "sensor_msgs/Image", 1.0,
              imageMessage(1.0, depthImage(500)).substr(0, 30));
    CHECK(mentions(streamRefusal(folder, maker), "topics: /c/depth/image_raw: truncated (allowed: "));
}

TEST_CASE("A bag without a colour stream that is read says why") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", depthImage(500));
    CHECK(playStreams(folder, maker).whyNoColour().find("no colour stream") != std::string::npos);
    addStream(maker, "/c/rgb/image_raw", {.encoding = "jp2k", .pixels = filledColour(1, 2, 3)});
    CHECK(playStreams(folder, maker).whyNoColour().find("/c/rgb/image_raw (jp2k)") != std::string::npos);
    addStream(maker, "/c/left/image_mono", {.encoding = "mono8", .pixels = filled(uint8_t{9})});
    CHECK(playStreams(folder, maker).whyNoColour().find("grey") != std::string::npos);
    addStream(maker, "/c/color/image_raw", redImage());
    CHECK(playStreams(folder, maker).whyNoColour().empty());
}
