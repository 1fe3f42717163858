// SPDX-License-Identifier: Apache-2.0
// Bags with images that programs computed from the camera's: labels and overlays.
#include "tests/devices/played_bag.h"

using namespace fathom;
using namespace fathom::test;

namespace {

const std::string kOwnColour = "/camera/color/image_raw", kOwnDepth = "/camera/depth/image_rect_raw";
const std::array<double, 4> kColourLens{6.0, 6.0, 3.5, 2.5};

// A camera whose depth and colour are related by tf, with one more topic that has colour's or depth's lens.
BagMaker besideCamera(const std::string& topic, bool likeDepth) {
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

} // namespace

TEST_CASE("Labels and overlays with a camera's frame and lens are not played instead of its own images") {
    const TemporaryFolder folder;
    for (const bool likeDepth : {false, true}) {
        for (const char* topic :
             {"/seg/image", "/detector/instance/image", "/yolo/detections/image", "/detector/overlay/image",
              "/tracker/image", "/camera/heatmap/image", "/camera/overlay/image", "/camera/panoptic"}) {
            CAPTURE(topic);
            BagCamera camera = playStreams(folder, besideCamera(topic, likeDepth));
            CHECK(camera.streamOptions() == ",depth=" + kOwnDepth + ",colour=" + kOwnColour);
            CHECK(firstDepth(camera) == doctest::Approx(0.6));
            CHECK_FALSE(camera.info().registered);
        }
    }
}
