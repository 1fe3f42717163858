// SPDX-License-Identifier: Apache-2.0
// How depth and colour of a bag are related where frames, topics and tf say different things.
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kPoseTopic = "/camera/depth_to_color";

// Shifted by 50 mm along x; without rotation, or with a matrix of zeros, which is none.
void addDriverPose(BagMaker& maker, bool valid = true) {
    Out message{stampedHeader(1.0, "")};
    for (int i = 0; i < 9; ++i) {
        message.put(valid && i % 4 == 0 ? 1.0 : 0.0);
    }
    message.put(valid ? 0.05 : 0.0).put(0.0).put(0.0);
    maker.add(kPoseTopic, "realsense2_camera/Extrinsics", 1.0, message.bytes);
}

void addTf(BagMaker& maker, const std::string& topic, double t, double x) {
    Out link{Out().put(uint32_t{1}).bytes + stampedHeader(t, "depth_optical")};
    link.text("color_optical").bytes += transformMessage(x, 0.0, 0.0);
    maker.add(topic, "tf2_msgs/TFMessage", t, link.bytes);
}

// Depth of its own camera, and colour of another frame and lens.
BagMaker twoFrames() {
    BagMaker maker;
    addStream(maker, "/camera/depth/image_raw", depthImage(500, "depth_optical"), {.frame = "depth_optical"});
    addStream(maker, "/camera/color/image_raw", redImage("color_optical"),
              {.frame = "color_optical", .k = {6.0, 6.0, 3.5, 2.5}});
    return maker;
}

// Colour at x [m] from depth, turned about y.
BagMaker turnedRig(double x, double degrees, const std::string& encoding = "rgb8") {
    BagMaker maker;
    addStream(maker, "/camera/depth/image_raw", depthImage(500, "depth_optical"), {.frame = "depth_optical"});
    ImageMessage colour = redImage("color_optical");
    if (encoding == "mono8") {
        colour = {.frame = "color_optical", .encoding = encoding, .pixels = filled(uint8_t{9})};
    }
    addStream(maker, "/camera/color/image_raw", colour,
              {.frame = "color_optical", .k = {6.0, 6.0, 3.5, 2.5}});
    Out link{Out().put(uint32_t{1}).bytes + stampedHeader(1.0, "depth_optical")};
    const double half = degrees * std::acos(-1.0) / 360.0;
    link.text("color_optical").put(x).put(0.0).put(0.0);
    link.put(0.0).put(std::sin(half)).put(0.0).put(std::cos(half));
    maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, link.bytes);
    return maker;
}

bool warns(const BagCamera& camera, const std::string& part) {
    const auto all = camera.warnings();
    return std::ranges::any_of(all,
                               [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

} // namespace

TEST_CASE("The driver's extrinsics topic moves nothing between depth and colour of one frame") {
    const TemporaryFolder folder;
    const InfoMessage bent{.distortion = {0.05, -0.1, 0.0, 0.0, 0.01}},
        anew{.distortion = {0.05, -0.1, 0.0, 0.0, 0.01}, .k = {6.8, 6.8, 3.6, 2.4}},
        cropped{.roi = {2, 1, 4, 6}};
    for (const InfoMessage& lens : {bent, anew, cropped}) {
        for (const bool topic : {false, true}) {
            const bool crop = lens.roi[2] > 0;
            BagMaker maker;
            addStream(maker, "/camera/aligned_depth_to_color/image_raw", depthImage(500));
            ImageMessage image = redImage();
            if (crop) {
                image.width = 6;
                image.height = 4;
                image.pixels = filledColour(200, 10, 10, 24);
            }
            addStream(maker, "/camera/color/image_raw", image, lens);
            if (topic) {
                addDriverPose(maker);
            }
            const CameraInfo info = playStreams(folder, maker).info();
            CHECK_FALSE(info.registered);
            CHECK(glm::length(info.colourTdepth.position) == 0.0);
            CHECK(info.colour.width == (crop ? 6 : 8));
        }
    }
}

TEST_CASE("Depth and colour of one frame and other focal lengths do not take the topic, with a warning") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/camera/depth/image_raw", depthImage(500));
    addStream(maker, "/camera/color/image_raw", redImage(), {.k = {6.0, 6.0, 3.5, 2.5}});
    mentions(streamRefusal(folder, maker), "extrinsics: missing");
    addDriverPose(maker);
    const BagCamera camera = playStreams(folder, maker);
    CHECK(glm::length(camera.info().colourTdepth.position) == 0.0);
    CHECK(warns(camera, "depth and colour are both in frame 'camera': " + kPoseTopic + " is not used"));
}

TEST_CASE("Colour of a right camera is the baseline apart in the frame of depth named registered") {
    const TemporaryFolder folder;
    const std::array<double, 4> lens{7.0, 7.0, 3.5, 2.5};
    for (const char* depth : {"/stereo/depth_registered/image_rect", "/stereo/depth/image_rect"}) {
        BagMaker maker;
        addStream(maker, depth, depthImage(500), {.p = lens});
        addStream(maker, "/stereo/right/image_rect_color", redImage(), {.p = lens, .tx = -0.84});
        const CameraInfo info = playStreams(folder, maker).info();
        CHECK_FALSE(info.registered);
        CHECK(info.colourTdepth.position.x == doctest::Approx(-0.12));
    }
    BagMaker aligned; // a driver writes the same P for all of its images
    addStream(aligned, "/camera/aligned_depth_to_color/image_raw", depthImage(500), {.p = lens, .tx = -0.84});
    addStream(aligned, "/camera/color/image_raw", redImage(), {.p = lens});
    CHECK(playStreams(folder, aligned).info().registered);
}

TEST_CASE("An extrinsics topic that is no pose gives way to tf, and is named") {
    const TemporaryFolder folder;
    BagMaker maker = twoFrames();
    addDriverPose(maker, false);
    const std::string refused = streamRefusal(folder, maker);
    mentions(refused, "extrinsics: " + kPoseTopic + ": an invalid transform (allowed: ");
    addTf(maker, "/tf_static", 1.0, -0.015);
    const BagCamera camera = playStreams(folder, maker);
    CHECK(camera.info().colourTdepth.position.x == doctest::Approx(0.015));
    CHECK(warns(camera, kPoseTopic + ": an invalid transform: tf is used"));
}

TEST_CASE("Two transforms of one link of tf that nearly agree are one, and others are named") {
    const TemporaryFolder folder;
    BagMaker two = twoFrames(), jitter = twoFrames(), apart = twoFrames(), moving = twoFrames();
    addTf(two, "/tf_static", 1.0, -0.015);
    addTf(two, "/tf_static", 1.0, -0.0153);
    const BagCamera camera = playStreams(folder, two);
    CHECK(camera.info().colourTdepth.position.x == doctest::Approx(0.015));
    CHECK(warns(camera, "differ by 0.3 mm"));
    for (int i = 0; i < 20; ++i) {
        addTf(jitter, "/tf", 1.0 + 0.01 * i, -0.015 - 1e-5 * (i % 2));
        addTf(moving, "/tf", 1.0 + 0.01 * i, -0.015 - 2e-4 * i);
    }
    CHECK(playStreams(folder, jitter).info().colourTdepth.position.x == doctest::Approx(0.015));
    addTf(apart, "/tf_static", 1.0, -0.015);
    addTf(apart, "/tf_static", 1.0, -0.06);
    mentions(streamRefusal(folder, apart),
             "extrinsics: missing; tf has 'color_optical' in 'depth_optical' at "
             "(-15.0, 0.0, 0.0) mm and at (-60.0, 0.0, 0.0) mm (allowed: ");
    mentions(streamRefusal(folder, moving),
             "extrinsics: missing; tf has 'color_optical' in 'depth_optical' at ");
}

TEST_CASE("A pose of a bag that no lenses of one rig have is named with its source") {
    const TemporaryFolder folder;
    const std::string tf = "tf between 'depth_optical' and 'color_optical': ";
    CHECK(warns(playStreams(folder, turnedRig(4.0, 0.0)),
                tf + "4 m between the lenses (allowed: at most 1 m; metres, not millimetres)"));
    CHECK(warns(playStreams(folder, turnedRig(0.0, 180.0)),
                tf + "180 degrees between the optical axes (allowed: optical axes within 90 degrees"));
    mentions(
        streamRefusal(folder, turnedRig(15.0, 0.0)),
        ": extrinsics: " + tf +
            "15 m between the lenses (allowed: at most 1 m; metres, not millimetres; or extrinsics=FILE or "
            "colour=none after the file name)");
    CHECK_FALSE(playStreams(folder, turnedRig(15.0, 0.0), {.colour = "none"}).info().hasColour);
    const CameraInfo grey = playStreams(folder, turnedRig(15.0, 0.0, "mono8")).info();
    CHECK_FALSE(grey.hasColour); // grey is not worth a refusal
    BagMaker pair;               // P in millimetres
    addStream(pair, "/stereo/depth/image_rect", depthImage(500), {.p = {7.0, 7.0, 3.5, 2.5}});
    addStream(pair, "/stereo/right/image_rect_color", redImage(), {.p = {7.0, 7.0, 3.5, 2.5}, .tx = -840.0});
    mentions(streamRefusal(folder, pair), "P of the camera_info of /stereo/depth/image_rect and "
                                          "/stereo/right/image_rect_color: 120 m between the lenses");
}

TEST_CASE("Poses of cameras side by side, converging or on one arm have no warning") {
    const TemporaryFolder folder;
    for (const auto& [x, degrees] : {std::pair(0.015, 0.0), {0.3, 30.0}, {0.95, -20.0}, {0.5, 85.0}}) {
        const BagCamera camera = playStreams(folder, turnedRig(x, degrees));
        CHECK_FALSE(warns(camera, "(allowed: "));
        CHECK(camera.info().hasColour);
    }
    CHECK_FALSE(warns(playStreams(folder, turnedRig(4.0, 0.0, "mono8")), "between the lenses"));
}

TEST_CASE("Depth and colour of two robots with equal frames are named, unless they are asked for") {
    const TemporaryFolder folder;
    const auto warned = [&](const std::string& depth, const std::string& colour, const std::string& frame,
                            const SourceOptions& options = {}) {
        BagMaker maker;
        addStream(maker, depth, depthImage(500, frame + "depth_optical"), {.frame = frame + "depth_optical"});
        addStream(maker, colour, redImage("color_optical"),
                  {.frame = "color_optical", .k = {6.0, 6.0, 3.5, 2.5}});
        Out link{Out().put(uint32_t{1}).bytes + stampedHeader(1.0, frame + "depth_optical")};
        link.text("color_optical").bytes += transformMessage(0.015, 0.0, 0.0);
        maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, link.bytes);
        return warns(playStreams(folder, maker, options), "may be of two robots, ");
    };
    const std::string depth = "/robot1/camera/depth/image_raw", colour = "/robot2/camera/color/image_raw";
    CHECK(warned(depth, colour, ""));
    CHECK_FALSE(warned(depth, colour, "", {.depth = depth, .colour = colour}));
    CHECK_FALSE(warned(depth, colour, "robot1_"));
    CHECK_FALSE(warned(depth, "/robot1/camera/color/image_raw", ""));
    CHECK_FALSE(warned("/depth/camera/image_raw", "/rgb/camera/image_raw", ""));
    CHECK_FALSE(warned("/tof/depth", "/web/image_color", ""));
}
