// SPDX-License-Identifier: Apache-2.0
// The product's camera on vivid, the kernel's virtual camera: formats that UVC depth cameras lack, and
// deliberate driver errors.
#include "engine/types/colour_copy.h"
#include "tests/vm/camera/live_camera.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cstdlib>
#include <linux/videodev2.h>

using namespace fathom;
using namespace fathom::vm;

namespace {

struct Vivid {
    explicit Vivid(int count = 1) {
        const std::string types = count == 1 ? "1" : "1,1";
        REQUIRE(std::system(
                    ("modprobe vivid n_devs=" + std::to_string(count) + " node_types=" + types).c_str()) ==
                0);
        REQUIRE(waitForFile("/dev/video" + std::to_string(count - 1)));
    }
    ~Vivid() {
        std::system("rmmod vivid");
        waitForNoCamera();
    }
};

// Presses a control button of vivid, by name.
void press(const std::string& name) {
    const VideoNode node("/dev/video0");
    v4l2_queryctrl query{};
    for (query.id = V4L2_CTRL_FLAG_NEXT_CTRL; node.control(VIDIOC_QUERYCTRL, &query) == 0;
         query.id |= V4L2_CTRL_FLAG_NEXT_CTRL) {
        if (name == reinterpret_cast<const char*>(query.name)) {
            v4l2_control value{query.id, 1};
            node.control(VIDIOC_S_CTRL, &value);
            return;
        }
    }
    FAIL("vivid has no control " << name);
}

} // namespace

TEST_CASE("Grey formats of 10, 12 and 16 bits are read as depth when requested by name") {
    const Vivid vivid;
    const IntrinsicsFile lens(640, 360);
    const std::string file = ",colour=none,intrinsics=" + lens.path().string();
    for (const auto& [name, most] :
         {std::pair{"Y10", 0x3ff}, std::pair{"Y12", 0xfff}, std::pair{"Y16", 0xffff}}) {
        V4l2Camera camera(parseCameraRequest("v4l2:/dev/video0,format=" + std::string(name) + file));
        for (int i = 0; i < 3; ++i) {
            const auto frame = camera.next();
            REQUIRE(frame);
            const auto [low, high] = std::minmax_element((*frame)->depth.begin(), (*frame)->depth.end());
            CHECK(*high <= most);
            CHECK(*high > most / 2); // the test bars include white
            CHECK(*low < most / 8);  // and black
        }
        CHECK(camera.copied() == (most == 0xffff ? 0u : 3u));
    }
    CHECK(cameraRefusal("v4l2:/dev/video0" + file).find("no depth on /dev/video0, which has YUYV") !=
          std::string::npos);
}

TEST_CASE("Colour of three bytes per pixel is read in either order, with depth from another device") {
    const Vivid vivid(2);
    const IntrinsicsFile lens(640, 360);
    for (const char* name : {"RGB3", "BGR3"}) {
        CAPTURE(name);
        V4l2Camera camera(parseCameraRequest("v4l2:/dev/video0,format=Y16,colour=/dev/video1,colour_format=" +
                                             std::string(name) + ",intrinsics=" + lens.path().string()));
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->raw.bytes.size() == 3 * 640 * 360); // not converted
        const std::vector<uint32_t> colours = coloursOf(**frame);
        // Eight bars: white, yellow, cyan, green, magenta, red, blue, black. Its text is above.
        const uint32_t red = colours[300 * 640 + 440], blue = colours[300 * 640 + 520];
        CHECK((red & 255) > 150);
        CHECK((red >> 8 & 255) < 60);
        CHECK((red >> 16 & 255) < 60);
        CHECK((blue & 255) < 60);
        CHECK((blue >> 16 & 255) > 150);
    }
}

TEST_CASE("Gain is set through the kernel once its automatic is off, and what the driver lacks says so") {
    const Vivid vivid;
    V4l2Controls controls(std::vector<V4l2Controls::Node>{{"depth", "/dev/video0"}});
    const auto named = [&](const std::string& name) {
        for (const CameraControl& control : controls.read()) {
            if (control.name == name) {
                return control;
            }
        }
        FAIL("no control " << name);
        return CameraControl();
    };
    REQUIRE(controls.set(named("auto gain"), 1).empty());
    CHECK(named("auto gain").isSwitch);
    REQUIRE(controls.set(named("auto gain"), 0).empty());
    CHECK(named("auto gain").value == 0);
    const CameraControl gain = named("gain");
    REQUIRE(gain.fixed.empty());
    REQUIRE(gain.most > gain.least + 10);
    REQUIRE(controls.set(gain, gain.least + 7).empty());
    CHECK(named("gain").value == gain.least + 7);
    CHECK(named("exposure").fixed == "not offered by the camera's driver");
    CHECK(named("laser or emitter").fixed == "not offered by the camera's driver");
    controls.moveTo({{"depth", "/dev/video99"}}); // unplugged
    CHECK(controls.read().empty());
    CHECK(controls.set(gain, 1).find("/dev/video99") != std::string::npos);
}

TEST_CASE("A stream that ends in a fatal error is restarted; a device reported as disconnected is lost") {
    const Vivid vivid;
    const IntrinsicsFile lens(640, 360);
    CameraRequest request =
        parseCameraRequest("v4l2:/dev/video0,format=Y16,colour=none,intrinsics=" + lens.path().string());
    request.silence = 0.5;
    V4l2Camera camera(request);
    REQUIRE(camera.next());
    press("Inject Fatal Streaming Error");
    for (int i = 0; i < 8; ++i) { // buffered frames, then frames of the restarted stream
        CHECK(camera.next());
    }
    press("Disconnect");
    CHECK_THROWS_AS(
        [&camera] {
            for (int i = 0; i < 20; ++i) {
                camera.next();
            }
        }(),
        DeviceLost);
}
