// SPDX-License-Identifier: Apache-2.0
// Where the pose between depth and colour of a bag comes from.
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Depth and colour, by default of different lenses, without extrinsics.
BagMaker unrelatedBag(const std::string& depth, const std::string& colour,
                      const InfoMessage& lens = {.frame = "depth", .k = {6.0, 6.0, 3.0, 2.0}}) {
    BagMaker maker;
    addStream(maker, "/camera/depth/image_rect_raw", depthImage(900, depth), lens);
    addStream(maker, "/camera/color/image_raw", redImage(colour));
    return maker;
}

// Shifted along x. sine: of a turn about x, whose matrix is written column by column.
void addExtrinsics(BagMaker& maker, const std::string& topic, double x,
                   const std::string& type = "realsense2_camera/Extrinsics", double sine = 0.0) {
    const double cosine = std::sqrt(1.0 - sine * sine);
    Out extrinsics{stampedHeader(1.0, "")};
    for (const double value : {1.0, 0.0, 0.0, 0.0, cosine, sine, 0.0, -sine, cosine, x, 0.0, 0.001}) {
        extrinsics.put(value);
    }
    maker.add(topic, type, 1.0, extrinsics.bytes);
}

// A message of tf with one transform.
std::string frameLink(const std::string& parent, const std::string& child, double x) {
    return Out().put(uint32_t{1}).bytes + stampedHeader(1.0, parent) + Out().text(child).bytes +
           transformMessage(x, 0.0, 0.0);
}

} // namespace

TEST_CASE(
    "Depth and colour that are not registered are related by the SDK's, realsense-ros' or tf's extrinsics") {
    const TemporaryFolder folder;
    const auto bare = [] { return unrelatedBag("depth", "color"); };
    CHECK(streamRefusal(folder, bare()).find("extrinsics: missing") != std::string::npos);
    BagMaker topic = bare();
    addExtrinsics(topic, "/camera/extrinsics/depth_to_color", 0.015);
    CHECK(playStreams(folder, topic).info().colourTdepth.position.x == doctest::Approx(0.015));
    BagMaker frames = bare();
    frames.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("base", "depth", 0.02));
    frames.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("base", "color", 0.005));
    const BagCamera camera = playStreams(folder, frames);
    CHECK_FALSE(camera.info().registered);
    CHECK(camera.info().colourTdepth.position.x == doctest::Approx(0.015));
    frames.add("/tf", "tf2_msgs/TFMessage", 2.0, frameLink("base", "color", 0.1)); // it moves: not used
    CHECK(streamRefusal(folder, frames).find("extrinsics: missing") != std::string::npos);
    folder.write("e.json", R"({"t": [0.03, 0, 0], "q_xyzw": [0, 0, 0, 1]})");
    CHECK(playStreams(folder, bare(), {.extrinsics = folder.path() / "e.json"})
              .info()
              .colourTdepth.position.x == doctest::Approx(0.03));
}

TEST_CASE(
    "Colour of the second camera of a rectified stereo pair is apart from depth by the baseline of its P") {
    const TemporaryFolder folder;
    const auto pair = [](double depth, double colour, const std::string& frame) {
        BagMaker maker;
        addStream(maker, "/cam/depth/image_rect", depthImage(900, "cam"),
                  {.frame = "cam", .p = {7.0, 7.0, 3.5, 2.5}, .tx = depth});
        addStream(maker, "/cam/color/image_rect", redImage(frame),
                  {.frame = frame, .p = {7.0, 7.0, 3.5, 2.5}, .tx = colour});
        return maker;
    };
    CHECK(playStreams(folder, pair(0.0, 0.0, "cam")).info().registered);
    CHECK(playStreams(folder, pair(-0.35, -0.35, "cam")).info().registered);
    const CameraInfo right = playStreams(folder, pair(0.0, -0.35, "cam")).info();
    CHECK_FALSE(right.registered);
    CHECK(right.colourTdepth.position.x == doctest::Approx(-0.05));
    const CameraInfo left = playStreams(folder, pair(-0.35, 0.0, "cam")).info();
    CHECK_FALSE(left.registered);
    CHECK(left.colourTdepth.position.x == doctest::Approx(0.05));
    BagMaker frames = pair(0.0, -0.35, "right"); // of its own frame: tf has the baseline
    frames.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("cam", "right", 0.05));
    CHECK(playStreams(folder, frames).info().colourTdepth.position.x == doctest::Approx(-0.05));
}

TEST_CASE("A pose of tf between frames that may be those of a robot's body, not of images, has a warning") {
    const TemporaryFolder folder;
    const auto doubts = [&](const std::string& depth, const std::string& colour, bool opticalChild = false) {
        BagMaker maker = unrelatedBag(depth, colour, {.frame = depth, .k = {6.0, 6.0, 3.0, 2.0}});
        maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink(depth, colour, 0.05));
        if (opticalChild) {
            Out turned{Out().put(uint32_t{1}).bytes + stampedHeader(1.0, colour)};
            turned.text("color_optical_frame");
            for (const double value : {0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5}) {
                turned.put(value);
            }
            maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, turned.bytes);
        }
        const auto said = playStreams(folder, maker).warnings();
        return std::any_of(said.begin(), said.end(), [](const std::string& line) {
            return line.find("in axes of images (x right, y down, z forward)") != std::string::npos;
        });
    };
    CHECK(doubts("depth_link", "color_link"));
    CHECK(doubts("depth_link", "color_link", true));
    CHECK_FALSE(doubts("depth_optical_frame", "color_Optical"));
}

TEST_CASE("The extrinsics topic of one camera does not relate depth or colour of another camera") {
    const TemporaryFolder folder;
    const auto bagOf = [](const std::string& depth, const std::string& colour) {
        BagMaker maker;
        addStream(maker, depth, depthImage(900, "depth"), {.frame = "depth", .k = {6.0, 6.0, 3.0, 2.0}});
        addStream(maker, colour, redImage("color"));
        addExtrinsics(maker, "/ns/front/extrinsics/depth_to_color", 0.015);
        return maker;
    };
    const std::string front = "/ns/front/depth/image_rect_raw", top = "/ns/top/depth/image_rect_raw";
    CHECK(playStreams(folder, bagOf(front, "/ns/front/color/image_raw")).info().colourTdepth.position.x ==
          doctest::Approx(0.015));
    for (const auto& [depth, colour] :
         {std::pair(front, "/ns/top/color/image_raw"), std::pair(top, "/ns/top/color/image_raw"),
          std::pair(top, "/ns/front/color/image_raw")}) {
        BagMaker maker = bagOf(depth, colour);
        CHECK(mentions(streamRefusal(folder, maker), "extrinsics: missing"));
        maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("depth", "color", -0.3));
        CHECK(playStreams(folder, maker).info().colourTdepth.position.x == doctest::Approx(0.3));
    }
}

TEST_CASE("Depth named registered is registered to the colour of its own camera, not of another one") {
    const TemporaryFolder folder;
    const auto bagOf = [](const std::string& depth, const std::string& colour, const std::string& frame) {
        BagMaker maker;
        addStream(maker, depth, depthImage(900, frame));
        addStream(maker, colour, redImage(frame.empty() ? "" : "color"));
        return maker;
    };
    for (const char* depth :
         {"/ns/a/aligned_depth_to_color/image_raw", "/ns/a/depth_registered/image_rect"}) {
        for (const char* own : {"/ns/a/color/image_raw", "/ns/a/left/image_rect_color", "/ns/a/image_raw"}) {
            CHECK(playStreams(folder, bagOf(depth, own, "depth")).info().registered);
            CHECK(playStreams(folder, bagOf(depth, own, "")).info().registered);
        }
        for (const char* other : {"/ns/b/color/image_raw", "/color/image_raw"}) {
            CHECK(mentions(streamRefusal(folder, bagOf(depth, other, "")), "extrinsics: missing"));
            BagMaker maker = bagOf(depth, other, "depth");
            CHECK(mentions(streamRefusal(folder, maker), "extrinsics: missing"));
            maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("depth", "color", -0.05));
            const CameraInfo apart = playStreams(folder, maker).info();
            CHECK_FALSE(apart.registered);
            CHECK(apart.colourTdepth.position.x == doctest::Approx(0.05));
        }
    }
    // One name for all cameras of a robot: tf tells them apart.
    BagMaker robot = bagOf("/robot/depth_registered/image_rect", "/robot/color/image_raw", "depth");
    robot.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("depth", "color", -1.0));
    CHECK_FALSE(playStreams(folder, robot).info().registered);
}

TEST_CASE(
    "Extrinsics of Orbbec's driver are read row by row, and as millimetres where they are metres apart") {
    const TemporaryFolder folder;
    const auto poseOf = [&](const std::string& type, double x) {
        BagMaker maker = unrelatedBag("depth", "color");
        addExtrinsics(maker, "/camera/depth_to_color", x, type, 0.1);
        return playStreams(folder, maker).info().colourTdepth;
    };
    const double half = std::sin(0.5 * std::asin(0.1));
    CHECK(poseOf("realsense2_camera_msgs/Extrinsics", 0.03).rotation.x == doctest::Approx(half));
    for (const char* type :
         {"orbbec_camera_msgs/Extrinsics", "orbbec_camera/Extrinsics", "astra_camera_msgs/Extrinsics"}) {
        CHECK(poseOf(type, 0.03).rotation.x == doctest::Approx(-half));
        CHECK(poseOf(type, 0.03).position.x == doctest::Approx(0.03));
        CHECK(poseOf(type, 32.0).position.x == doctest::Approx(0.032));
    }
}

TEST_CASE(
    "An extrinsics topic that is the inverse of tf gives way to it; another contradiction has a warning") {
    const TemporaryFolder folder;
    const auto bagOf = [](double topic, double tf) {
        BagMaker maker = unrelatedBag("depth_optical", "color_optical",
                                      {.frame = "depth_optical", .k = {6.0, 6.0, 3.0, 2.0}});
        addExtrinsics(maker, "/camera/extrinsics/depth_to_color", topic);
        maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("depth_optical", "color_optical", tf));
        return maker;
    };
    const auto shown = [&](double topic, double tf, bool warned) {
        const BagCamera camera = playStreams(folder, bagOf(topic, tf));
        const auto said = camera.warnings();
        CHECK(warned == std::any_of(said.begin(), said.end(), [](const std::string& line) {
                  return line.find("depth_to_color, which is used, and tf between") != std::string::npos;
              }));
        return camera.info().colourTdepth.position.x;
    };
    CHECK(shown(0.015, -0.015, false) == doctest::Approx(0.015)); // tf has the pose of the other frame
    CHECK(shown(0.015, -0.017, false) == doctest::Approx(0.015)); // a drawing is not a calibration
    CHECK(shown(-0.015, -0.015, false) == doctest::Approx(0.015));
    CHECK(shown(0.015, -0.06, true) == doctest::Approx(0.015));
}

TEST_CASE("Colour of the right camera of a stereo pair is not registered to depth of the left one") {
    const TemporaryFolder folder;
    const auto bagOf = [](bool left, double tx, double tf) {
        const std::array<double, 4> lens{7.0, 7.0, 3.5, 2.5};
        BagMaker maker;
        addStream(maker, "/zed/right/image_rect_color", redImage("right_optical"),
                  {.frame = "right_optical", .p = lens, .tx = tx});
        addStream(maker, "/zed/depth/depth_registered", depthImage(900, "left_optical"),
                  {.frame = "left_optical", .p = lens});
        if (left) {
            addStream(maker, "/zed/left/image_rect_color", redImage("left_optical"),
                      {.frame = "left_optical", .p = lens});
        }
        if (tf != 0.0) {
            maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0,
                      frameLink("left_optical", "right_optical", tf));
        }
        return maker;
    };
    for (const double tf : {0.0, 0.063}) {
        const BagCamera both = playStreams(folder, bagOf(true, 0.0, tf));
        CHECK(both.streamOptions().find("colour=/zed/left") != std::string::npos);
        CHECK(both.info().registered);
    }
    CHECK(playStreams(folder, bagOf(false, -0.44, 0.0)).info().colourTdepth.position.x ==
          doctest::Approx(-0.44 / 7.0));
    const CameraInfo right = playStreams(folder, bagOf(false, 0.0, 0.063)).info();
    CHECK_FALSE(right.registered);
    CHECK(right.colourTdepth.position.x == doctest::Approx(-0.063));
    mentions(streamRefusal(folder, bagOf(false, 0.0, 0.0)), "extrinsics: missing (allowed: ");
}

TEST_CASE("Damaged messages and invalid transforms of other frames do not lose the extrinsics of a bag") {
    const TemporaryFolder folder;
    BagMaker maker = unrelatedBag("/depth", "color");
    Out bad = Out{Out().put(uint32_t{2}).bytes + stampedHeader(1.0, "base")}.text("wheel");
    bad.bytes += transformMessage(std::nan(""), 0.0, 0.0);
    bad.bytes += stampedHeader(1.0, "/base") + Out().text("depth").bytes + transformMessage(0.02, 0.0, 0.0);
    maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, bad.bytes);
    maker.add("/tf", "tf2_msgs/TFMessage", 1.0, raw(uint32_t{7})); // truncated
    maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("base", "/color", 0.005));
    CHECK(playStreams(folder, maker).info().colourTdepth.position.x == doctest::Approx(0.015));
}

TEST_CASE("A file of one lens replaces that of depth, and keeps how the bag relates colour to it") {
    const TemporaryFolder folder;
    const std::string lens = R"("width": 8, "height": 6, "fx": 9, "fy": 9, "cx": 3.5, "cy": 2.5)";
    folder.write("one.json", "{" + lens + "}");
    folder.write("registered.json", "{" + lens + R"(, "registered_to_color": true})");
    const SourceOptions one{.intrinsics = folder.path() / "one.json"},
        registered{.intrinsics = folder.path() / "registered.json"};
    BagMaker apart = unrelatedBag("depth", "color");
    CHECK(mentions(streamRefusal(folder, apart, one), "color: missing (allowed: blocks depth and color"));
    CHECK(playStreams(folder, apart, registered).info().registered);
    apart.add("/tf_static", "tf2_msgs/TFMessage", 1.0, frameLink("depth", "color", 0.005));
    const CameraInfo kept = playStreams(folder, apart, one).info();
    CHECK_FALSE(kept.registered);
    CHECK(kept.depth.fx == 9.0);
    CHECK(kept.colour.fx == 7.0);
    CHECK(kept.colourTdepth.position.x == doctest::Approx(-0.005));
    CHECK(playStreams(folder, apart, registered).info().registered);
    const CameraInfo same =
        playStreams(folder, unrelatedBag("depth", "depth", {.frame = "depth"}), one).info();
    CHECK(same.registered);
    CHECK(same.colour.fx == 9.0);
}

TEST_CASE("An SDK bag whose frames are all called 0 is related by its transforms, not by that name") {
    const TemporaryFolder folder;
    BagMaker maker;
    for (const char* name : {"/device_0/sensor_0/Depth_0", "/device_0/sensor_1/Color_0"}) {
        const bool depth = std::string(name).ends_with("Depth_0");
        maker.add(name + std::string("/info/camera_info"), "sensor_msgs/CameraInfo", 1.0,
                  infoMessage({.frame = "0"}));
        maker.add(name + std::string("/tf/0"), "geometry_msgs/Transform", 1.0,
                  transformMessage(depth ? 0.0 : 0.0147, 0.0, 0.0));
        maker.add(name + std::string("/image/data"), "sensor_msgs/Image", 1.0,
                  imageMessage(1.0, depth ? depthImage(500, "0", "mono16") : redImage("0")));
    }
    const BagCamera camera = playStreams(folder, maker);
    CHECK_FALSE(camera.info().registered);
    CHECK(camera.info().colourTdepth.position.x == doctest::Approx(0.0147));
}
