// SPDX-License-Identifier: Apache-2.0
// Lenses and poses of a bag that options give: intrinsics=FILE, extrinsics=FILE, info=TOPIC.
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

const InfoMessage kOtherLens{.frame = "color", .k = {5.0, 5.0, 3.5, 2.5}};

// Depth without a lens of its own, and colour with its own one.
BagMaker lenslessDepth(const std::string& depthFrame, const InfoMessage& colour, bool tf) {
    BagMaker maker;
    maker.add("/calib/depth_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({.frame = depthFrame}));
    for (const double t : {1.0, 1.1, 1.2}) {
        maker.add("/cam/depth/image", "sensor_msgs/Image", t, imageMessage(t, depthImage(500, depthFrame)));
    }
    addStream(maker, "/cam/rgb/image_raw", redImage(colour.frame), colour);
    if (tf) {
        Out link{Out().put(uint32_t{1}).bytes + stampedHeader(1.0, depthFrame)};
        link.text(colour.frame).bytes += transformMessage(-0.1, 0.0, 0.0);
        maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0, link.bytes);
    }
    return maker;
}

void checkApart(const CameraInfo& info) {
    CHECK_FALSE(info.registered);
    CHECK(info.depth.fx == 7.0);
    CHECK(info.colour.fx == 5.0);
    CHECK(info.colourTdepth.position.x == doctest::Approx(0.1));
}

} // namespace

TEST_CASE("A file of one lens for depth without a lens keeps the recorded relation of colour") {
    const TemporaryFolder folder;
    const std::string lens = R"("width": 8, "height": 6, "fx": 7, "fy": 7, "cx": 3.5, "cy": 2.5)";
    folder.write("one.json", "{" + lens + "}");
    folder.write("registered.json", "{" + lens + R"(, "registered_to_color": true})");
    folder.write("british.json", "{" + lens + R"(, "registered_to_colour": true})");
    const SourceOptions one{.intrinsics = folder.path() / "one.json"},
        registered{.intrinsics = folder.path() / "registered.json"},
        british{.intrinsics = folder.path() / "british.json"};
    checkApart(playStreams(folder, lenslessDepth("depth", kOtherLens, true), one).info());
    const BagMaker unrelated = lenslessDepth("depth", kOtherLens, false);
    mentions(streamRefusal(folder, unrelated, one),
             "color: missing (allowed: blocks depth and color, or registered_to_color: true");
    CHECK(playStreams(folder, unrelated, registered).info().registered);
    CHECK(playStreams(folder, unrelated, british).info().registered);
    CHECK(playStreams(folder, lenslessDepth("depth", kOtherLens, true), british).info().registered);
    // Depth in colour's frame is registered to it if the file has nearly colour's lens.
    InfoMessage near = kOtherLens;
    near.k = {6.8, 6.8, 3.6, 2.4};
    const CameraInfo same = playStreams(folder, lenslessDepth("color", near, false), one).info();
    CHECK(same.registered);
    CHECK(same.colour.fx == 7.0);
    mentions(streamRefusal(folder, lenslessDepth("color", kOtherLens, false), one), "color: missing");
}

TEST_CASE("A file of one lens plays a bag without any lens as registered, unless its frames differ") {
    const TemporaryFolder folder;
    folder.write("one.json", R"({"width": 8, "height": 6, "fx": 7, "fy": 7, "cx": 3.5, "cy": 2.5})");
    for (const char* frame : {"camera", "", "color"}) {
        BagMaker maker;
        for (const double t : {1.0, 1.1}) {
            const std::string depth = std::string(frame) == "color" ? "depth" : frame;
            maker.add("/cam/depth/image", "sensor_msgs/Image", t, imageMessage(t, depthImage(500, depth)));
            maker.add("/cam/rgb/image", "sensor_msgs/Image", t, imageMessage(t, redImage(frame)));
        }
        const SourceOptions one{.intrinsics = folder.path() / "one.json"};
        const std::string refused = streamRefusal(folder, maker, one);
        CHECK(refused.empty() == (std::string(frame) != "color"));
        CHECK((refused.empty() || mentions(refused, "color: missing (allowed: blocks depth and color")));
        CHECK((!refused.empty() || playStreams(folder, maker, one).info().registered));
    }
}

TEST_CASE("The topic of info=TOPIC is the lens of depth, and of colour only without one of its own") {
    const TemporaryFolder folder;
    const SourceOptions asked{.info = "/calib/depth_info"};
    checkApart(playStreams(folder, lenslessDepth("depth", kOtherLens, true), asked).info());
    mentions(streamRefusal(folder, lenslessDepth("color", kOtherLens, false), asked), "extrinsics: missing");
    BagMaker bare = lenslessDepth("color", kOtherLens, false);
    for (const double t : {1.0, 1.1, 1.2}) { // colour without a lens of its own
        bare.add("/left/rgb/image_raw", "sensor_msgs/Image", t, imageMessage(t, redImage("color")));
    }
    const CameraInfo info =
        playStreams(folder, bare, {.colour = "/left/rgb/image_raw", .info = "/calib/depth_info"}).info();
    CHECK(info.registered);
    CHECK(info.colour.fx == 7.0);
    BagMaker own; // depth's own lens gives way to the one that is asked for
    addStream(own, "/cam/depth/image", depthImage(500));
    own.add("/calib/depth_info", "sensor_msgs/CameraInfo", 1.0, infoMessage(kOtherLens));
    CHECK(playStreams(folder, own, asked).info().depth.fx == 5.0);
    mentions(streamRefusal(folder, own, {.info = "/cam/depth/image"}),
             "info: /cam/depth/image is sensor_msgs/Image (allowed: a topic of sensor_msgs/CameraInfo)");
}

TEST_CASE("Extrinsics of a file that are over a metre are refused with the file, the field and the unit") {
    const TemporaryFolder folder;
    folder.write("mm.json", R"({"t": [20, 0, 0], "q_xyzw": [0, 0, 0, 1]})");
    folder.write("far.json", R"({"t": [0.9, 0.9, 0], "q_xyzw": [0, 0, 0, 1]})");
    const BagMaker maker = lenslessDepth("depth", kOtherLens, false);
    const auto refused = [&](const char* name) {
        return streamRefusal(folder, maker,
                             {.info = "/calib/depth_info", .extrinsics = folder.path() / name});
    };
    mentions(refused("mm.json"), "mm.json: t: 20 m between the lenses (allowed: at most 1 m; metres, not "
                                 "millimetres)");
    mentions(refused("far.json"), "far.json: t: 1.273 m between the lenses");
}

TEST_CASE("Extrinsics of a file whose q_xyzw has w first, or no unit length, are refused with the order") {
    const TemporaryFolder folder;
    const BagMaker maker = lenslessDepth("depth", kOtherLens, false);
    const auto refused = [&](const std::string& q) {
        folder.write("e.json", R"({"t": [0.1, 0, 0], "q_xyzw": [)" + q + "]}");
        return streamRefusal(folder, maker,
                             {.info = "/calib/depth_info", .extrinsics = folder.path() / "e.json"});
    };
    mentions(refused("1, 0, 0, 0"),
             "e.json: q_xyzw: [1,0,0,0] (allowed: x y z w, in this order, with optical "
             "axes within 90 degrees of each other)");
    mentions(refused("0.9999, 0.01, 0.003, -0.005"), "e.json: q_xyzw: ");
    mentions(refused("0, 0, 10, 0.5"), "e.json: q_xyzw: [0,0,10,0.5] (allowed: a quaternion x y z w, in this "
                                       "order, of length 1; its length is 10.01)");
    CHECK(refused("0, 0, 0.7071068, 0.7071068") == ""); // a roll
    CHECK(refused("0, 0, 1, 0") == "");
    CHECK(refused("0.3826834, 0, 0, 0.9238795") == ""); // 45 degrees down
}

TEST_CASE("Aligned depth with another camera's lens than colour has a warning that names both") {
    const auto warned = [](const std::string& topic, const std::string& frame,
                           const std::array<double, 4>& k) {
        const TemporaryFolder folder;
        BagMaker maker;
        addStream(maker, topic, depthImage(500, frame), {.frame = frame, .k = k});
        addStream(maker, "/camera/color/image_raw", redImage());
        std::string all;
        for (const std::string& line : playStreams(folder, maker).warnings()) {
            all += line + "\n";
        }
        return all;
    };
    const std::string aligned = "/camera/aligned_depth_to_color/image_raw";
    mentions(warned(aligned, "camera", {5.0, 5.0, 3.5, 2.5}),
             aligned + " (fx 5.0) is named as aligned to colour, but has another lens than "
                       "/camera/color/image_raw (fx 7.0)");
    CHECK(warned(aligned, "camera", {7.0, 7.0, 3.5, 2.5}) == "");
    CHECK(warned(aligned, "camera", {6.8, 6.8, 3.6, 2.4}) == "");
}

TEST_CASE("A colour lens that cannot be used is rejected with the options that play the recording") {
    const TemporaryFolder folder;
    const auto bagOf = [](const InfoMessage& colour) {
        BagMaker maker;
        addStream(maker, "/cam/depth/image_raw", depthImage(500, "depth"), {.frame = "depth"});
        addStream(maker, "/cam/rgb/image_raw", redImage("rgb"), colour);
        return maker;
    };
    const BagMaker omni = bagOf({.frame = "rgb", .model = "omni", .distortion = {0.1, 0.0, 0.0, 0.0}}),
                   sized = bagOf({.frame = "rgb", .width = 80});
    for (const BagMaker& maker : {omni, sized}) {
        const std::string refusal = streamRefusal(folder, maker);
        mentions(refusal, "/cam/rgb/camera_info: ");
        mentions(refusal, "; or colour=none or intrinsics=FILE after the file name");
        BagCamera camera = playStreams(folder, maker, {.colour = "none"});
        CHECK(firstDepth(camera) == doctest::Approx(0.5));
    }
    mentions(streamRefusal(folder, sized), "applied; or colour=none or intrinsics=FILE after the file name)");
    BagMaker none;
    addStream(none, "/cam/depth/image_raw", depthImage(500, "depth"), {.frame = "depth"});
    none.add("/cam/rgb/image_raw", "sensor_msgs/Image", 1.0, imageMessage(1.0, redImage("rgb")));
    mentions(streamRefusal(folder, none),
             "or intrinsics=FILE after the file name; or colour=none after the file name)");
}
