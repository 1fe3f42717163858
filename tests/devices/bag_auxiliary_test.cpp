// SPDX-License-Identifier: Apache-2.0
// Bags with images that programs computed from the camera's: labels, overlays, inverse depth.
#include "tests/devices/played_bag.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kOwnColour = "/camera/color/image_raw", kOwnDepth = "/camera/depth/image_rect_raw";
const std::array<double, 4> kColourLens{6.0, 6.0, 3.5, 2.5};

// A camera whose depth and colour are related by tf, with one more topic that has colour's or depth's lens.
BagMaker cameraWithTopic(const std::string& topic, bool likeDepth) {
    BagMaker maker;
    addStream(maker, kOwnColour, redImage("color"), {.frame = "color", .k = kColourLens});
    addStream(maker, kOwnDepth, depthImage(600, "depth"), {.frame = "depth"});
    if (likeDepth) {
        addStream(maker, topic, redImage("depth"), {.frame = "depth"});
    } else {
        addStream(maker, topic, depthImage(3, "color"), {.frame = "color", .k = kColourLens});
    }
    maker.add("/tf_static", "tf2_msgs/TFMessage", 1.0,
              Out().put(uint32_t{1}).bytes + stampedHeader(1.0, "depth") + Out().text("color").bytes +
                  transformMessage(0.015, 0.0, 0.0));
    return maker;
}

std::string simulatorChoice(const TemporaryFolder& folder, const std::vector<std::string>& depths) {
    BagMaker maker;
    addStream(maker, "/drone/front/Scene", redImage());
    for (const std::string& topic : depths) {
        addStream(maker, topic, depthImage(700));
    }
    return playStreams(folder, maker).streamOptions();
}

} // namespace

TEST_CASE("Labels and overlays with a camera's frame and lens are not played instead of its own images") {
    const TemporaryFolder folder;
    for (const bool likeDepth : {false, true}) {
        for (const char* topic :
             {"/seg/image", "/detector/instance/image", "/yolo/detections/image", "/detector/overlay/image",
              "/tracker/image", "/camera/heatmap/image", "/camera/overlay/image", "/camera/panoptic"}) {
            CAPTURE(topic);
            BagCamera camera = playStreams(folder, cameraWithTopic(topic, likeDepth));
            CHECK(camera.streamOptions() == ",depth=" + kOwnDepth + ",colour=" + kOwnColour);
            CHECK(firstDepth(camera) == doctest::Approx(0.6));
            CHECK_FALSE(camera.info().registered);
        }
    }
}

TEST_CASE("Inverse and scaled depth of a simulator is not played as depth") {
    const TemporaryFolder folder;
    const std::string range = "/drone/front/DepthPerspective";
    for (const char* other : {"/drone/front/DepthVis", "/drone/front/DisparityNormalized"}) {
        for (const auto& depths : {std::vector<std::string>{range, other}, {other, range}}) {
            CHECK(simulatorChoice(folder, depths) == ",depth=" + range + ",colour=/drone/front/Scene");
        }
    }
}

TEST_CASE("Ranges are played where other images of floating point have no lens or are of another camera") {
    const TemporaryFolder folder;
    const std::string range = "/front/distance_to_camera";
    for (const bool colour : {false, true}) {
        BagMaker maker;
        for (const double t : {1.0, 1.1, 1.2}) {
            maker.add("/replay/image", "sensor_msgs/Image", t, imageMessage(t, depthImage(100, "replay")));
        }
        addStream(maker, range, depthImage(700));
        if (colour) {
            addStream(maker, "/front/rgb", redImage());
            addStream(maker, "/back/image", depthImage(500, "back"), {.frame = "back", .k = kColourLens});
        }
        const std::string chosen = playStreams(folder, maker).streamOptions();
        CHECK(chosen == ",depth=" + range + (colour ? ",colour=/front/rgb" : ",colour=none"));
    }
}
