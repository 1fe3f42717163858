// SPDX-License-Identifier: Apache-2.0
// The product's camera on the kernel's own uvcvideo and a simulated UVC camera.
#include "tests/vm/camera/live_camera.h"

#include "engine/types/colour_copy.h"

#include <set>
#include <thread>

using namespace fathom;
using namespace fathom::vm;

namespace {

int channel(uint32_t pixel, int i) {
    return static_cast<int>(pixel >> (8 * i) & 255);
}

void checkColour(const Frame& frame, uint32_t width, uint32_t height, int tolerance) {
    std::vector<uint32_t> rgba;
    readColours(*frame, rgba);
    REQUIRE(rgba.size() == width * height);
    const uint32_t red = rgba[5 * width + 5], blue = rgba[5 * width + width - 5];
    CHECK(channel(red, 0) >= 255 - tolerance);
    CHECK(channel(red, 1) <= tolerance);
    CHECK(channel(red, 2) <= tolerance);
    CHECK(channel(blue, 0) <= tolerance);
    CHECK(channel(blue, 2) >= 255 - tolerance);
}

} // namespace

TEST_CASE("A live camera delivers depth and colour as they were sent, stamped with the monotonic clock") {
    UvcCamera device({});
    device.plug();
    REQUIRE(waitForCamera());
    const IntrinsicsFile lens(320, 240, 0.0005);
    const auto camera = openLive(",intrinsics=" + lens.path().string() + ",frames=20");
    CHECK(camera->live());
    CHECK(camera->info().hasColour);
    CHECK(camera->info().colourFormat == ColourFormat::Yuyv); // not converted
    CHECK(camera->info().metresPerUnit == 0.0005);
    std::set<const void*> places;
    double last = 0.0;
    uint32_t count = 0;
    int number = -1;
    while (const auto frame = camera->next()) {
        const double now =
            std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
        CHECK((*frame)->index == count);
        CHECK((*frame)->captureTime > last);
        CHECK((*frame)->captureTime <= now);
        CHECK(isPlainDepth(*frame, 320));
        CHECK(int{(*frame)->depth[0]} > number);
        checkColour(*frame, 320, 240, 4);
        number = (*frame)->depth[0];
        last = (*frame)->captureTime;
        CHECK((*frame)->depthMemory.get() == (*frame)->depth.data()); // a device can read it there
        places.insert((*frame)->depth.data());
        ++count;
    }
    CHECK(count == 20);
    CHECK(camera->copied() == 0); // depth stayed in the driver's buffer
    CHECK(places.size() <= CaptureStream::kBuffers);
    CHECK(camera->next() == std::nullopt);
    MESSAGE("20 pairs of 320x240, " << camera->lost() << " lost, " << camera->skipped() << " skipped");
}

TEST_CASE("Frames held by the engine leave the driver two buffers; later frames are copies") {
    PluggedCamera plugged({.colour = false});
    const auto camera = plugged.open();
    std::vector<Frame> held;
    for (int i = 0; i < 4; ++i) {
        auto frame = camera->next();
        REQUIRE(frame);
        held.push_back(std::move(*frame));
    }
    CHECK(camera->copied() == 2);
    for (const Frame& frame : held) {
        CHECK(isPlainDepth(frame, 320)); // not overwritten while it is held
    }
    CHECK(held.back()->depthMemory.get() == held.back()->depth.data()); // the camera's own memory
    CHECK_FALSE(camera->info().hasColour);
    held.clear();
    CHECK(camera->next());
}

TEST_CASE("After a pause the camera gives a current frame, not a buffered one") {
    PluggedCamera plugged({});
    const auto camera = plugged.open();
    REQUIRE(camera->next());
    std::this_thread::sleep_for(std::chrono::milliseconds(1500)); // 45 frames; the driver buffers four
    const uint32_t sent = plugged.device.depth().sent;
    const auto frame = camera->next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] + 2u >= sent);
    CHECK(camera->lost() >= 30);
}

TEST_CASE("INZI depth is read in place behind the infrared plane, for any stride of the driver") {
    PluggedCamera plugged({.depthFormat = UvcFormat::Inzi});
    const auto camera = plugged.open();
    for (int i = 0; i < 5; ++i) {
        const auto frame = camera->next();
        REQUIRE(frame);
        CHECK(isPlainDepth(*frame, 320));
        checkColour(*frame, 320, 240, 4);
    }
    CHECK(camera->copied() == 0);
    CHECK(camera->skipped() == 0);
}

TEST_CASE("Motion JPEG colour is decoded") {
    PluggedCamera plugged(
        {.width = 64, .height = 48, .motionJpeg = true, .paintColour = redAndBlueJpeg(64, 48)});
    const auto camera = plugged.open();
    for (int i = 0; i < 3; ++i) {
        const auto frame = camera->next();
        REQUIRE(frame);
        checkColour(*frame, 64, 48, 40);
    }
}

TEST_CASE(
    "A separate colour camera with its own size, rate and pose gives each depth frame its nearest frame") {
    UvcCamera depth({.colour = false});
    depth.plug();
    REQUIRE(waitForCamera(false));
    const std::string depthNode = openVideoNodes().front().file().string();
    UvcCamera other({.width = 640, .height = 480, .serial = "COLOUR"}); // its depth is left alone
    other.plug();
    REQUIRE(waitForCamera());
    std::string colourNode;
    for (const VideoNode& node : openVideoNodes()) {
        colourNode = node.offers(fourccOf("YUYV")) ? node.file().string() : colourNode;
    }
    const testing::ScratchFile lens("two-lenses.json",
                                    R"({"registered_to_color": false, "depth_scale_m_per_unit": 0.001,
 "depth": {"width": 320, "height": 240, "fx": 300, "fy": 300, "cx": 160, "cy": 120},
 "color": {"width": 640, "height": 480, "fx": 610, "fy": 610, "cx": 320, "cy": 240},
 "extrinsics_topic_tf": {"Color": {"t": [0.1, 0, 0], "q_xyzw": [0, 0, 0, 1]}}})");
    V4l2Camera camera(
        parseCameraRequest("v4l2:" + depthNode + ",colour=" + colourNode +
                           ",rate=30,colour_rate=15,frames=20,intrinsics=" + lens.path().string()));
    CHECK(camera.info().colourTdepth.position.x == 0.1);
    std::set<uint32_t> colours; // pixel 0 encodes the frame number
    uint32_t count = 0;
    while (const auto frame = camera.next()) {
        CHECK(isPlainDepth(*frame, 320));
        checkColour(*frame, 640, 480, 4);
        colours.insert(static_cast<uint32_t>((*frame)->raw.bytes[0]));
        ++count;
    }
    CHECK(count == 20);
    CHECK(colours.size() >= 5);
    CHECK(colours.size() <= 14 + camera.lost()); // each is used twice, unless depth frames between were lost
    CHECK(camera.skipped() == 0);
}

TEST_CASE("An unavailable format is rejected with the list of available ones") {
    UvcCamera device({});
    device.plug();
    REQUIRE(waitForCamera());
    const IntrinsicsFile lens(320, 240);
    const std::string file = ",intrinsics=" + lens.path().string();
    CHECK(
        cameraRefusal("v4l2:auto").find("intrinsics: missing: this camera does not report its calibration") !=
        std::string::npos);
    CHECK(cameraRefusal("v4l2:auto,size=640x480" + file).find("320x240, the size that") != std::string::npos);
    const IntrinsicsFile large(640, 480);
    CHECK(cameraRefusal("v4l2:auto,intrinsics=" + large.path().string()).find("(allowed: Z16 320x240)") !=
          std::string::npos);
    CHECK(cameraRefusal("v4l2:/dev/video77" + file).find("/dev/video77: device: No such file") !=
          std::string::npos);
    CHECK(cameraRefusal("v4l2:/dev/null" + file).find("not a video device") != std::string::npos);
    CHECK(cameraRefusal("v4l2:auto,format=Y16" + file).find("no depth among") != std::string::npos);
    CHECK(cameraRefusal("v4l2:auto,colour_format=RGB3" + file).find("colour_format: RGB3") !=
          std::string::npos);
    const auto camera = openLive(file);
    CHECK(cameraRefusal("v4l2:auto" + file).find("a camera not in use by another program") !=
          std::string::npos);
}
