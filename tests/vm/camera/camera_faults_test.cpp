// SPDX-License-Identifier: Apache-2.0
// Camera faults on the kernel's own stack, and the product's reaction.
#include "tests/vm/camera/live_camera.h"

#include "engine/types/error.h"
#include "tests/realtime/listening.h"

#include <thread>

using namespace fathom;
using namespace fathom::vm;

namespace {

// The driver hides damaged frames unless this option is set; it is read at stream start.
class NoDrop {
public:
    NoDrop() { std::ofstream("/sys/module/uvcvideo/parameters/nodrop") << "1"; }
    ~NoDrop() { std::ofstream("/sys/module/uvcvideo/parameters/nodrop") << "0"; }
};

void readFrames(V4l2Camera& camera, int count) {
    for (int i = 0; i < count; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        REQUIRE(isPlainDepth(*frame, 320));
    }
}

} // namespace

TEST_CASE("Frames that the driver drops appear as gaps of its counter and are counted as lost") {
    PluggedCamera plugged({.colour = false});
    const auto camera = plugged.open();
    readFrames(*camera, 3);
    const uint64_t before = camera->lost();
    plugged.device.depth().faults.errorBit = 2;
    plugged.device.depth().faults.cutShort = 1;
    readFrames(*camera, 6);
    CHECK(camera->lost() >= before + 2); // the driver can miss one because of a toggle it did not see
    CHECK(plugged.device.depth().faults.errorBit == 0);
    CHECK(plugged.device.depth().faults.cutShort == 0);
    CHECK(camera->skipped() == 0);
}

TEST_CASE(
    "Gaps of the colour stream are counted separately and cost no pair where a neighbour is close enough") {
    PluggedCamera plugged({});
    CameraRequest request = plugged.request();
    request.everyFrame = true;
    V4l2Camera camera(request);
    readFrames(camera, 3);
    const uint64_t before = camera.lostColour(), depth = camera.lost();
    const testing::Listening log;
    plugged.device.colour().faults.errorBit = 3;
    readFrames(camera, 16);
    CHECK(plugged.device.colour().faults.errorBit == 0);
    CHECK(camera.lostColour() >= before + 2);
    CHECK(log.count("colour frames are missing") == (before == 0 ? 1u : 0u)); // logged once
    CHECK(camera.lost() == depth);
}

TEST_CASE(
    "A truncated frame and one with the error bit are skipped and counted when the driver passes them") {
    const NoDrop noDrop;
    PluggedCamera plugged({.colour = false});
    CameraRequest request = plugged.request();
    request.everyFrame = true; // no newer frame hides a damaged one
    V4l2Camera camera(request);
    readFrames(camera, 2);
    plugged.device.depth().faults.cutShort = 1;
    readFrames(camera, 8); // more than the driver has buffers
    CHECK(camera.skipped() == 1);
    plugged.device.depth().faults.errorBit = 1;
    readFrames(camera, 8);
    CHECK(camera.skipped() == 2);
}

TEST_CASE("A camera whose frames are all damaged counts as lost, and is used again when they are whole") {
    const NoDrop noDrop;
    PluggedCamera plugged({.colour = false});
    CameraRequest request = plugged.request();
    request.silence = 0.4;
    V4l2Camera camera(request);
    readFrames(camera, 2);
    plugged.device.depth().faults.errorBit = 1000000;
    std::string loss;
    while (loss.empty()) {
        loss = lossOf(camera);
    }
    CHECK(loss.find("frames arrive, but none is usable; last: the driver marks it as damaged") !=
          std::string::npos);
    plugged.device.depth().faults.errorBit = 0;
    readFrames(camera, 2);
}

TEST_CASE("A frame bit that does not change costs one frame") {
    PluggedCamera plugged({.colour = false});
    const auto camera = plugged.open();
    readFrames(*camera, 2);
    plugged.device.depth().faults.sameToggle = 1;
    readFrames(*camera, 5);
    CHECK(plugged.device.depth().faults.sameToggle == 0);
}

TEST_CASE(
    "A camera that is unplugged in mid-stream is lost at once, and the same one is found after it returns") {
    auto device = std::make_unique<UvcCamera>(UvcCameraOptions{});
    device->plug();
    REQUIRE(waitForCamera());
    const IntrinsicsFile lens(320, 240);
    const auto camera = openLive(",intrinsics=" + lens.path().string());
    auto held = camera->next();
    REQUIRE(held);
    std::thread pull([&device] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        device->unplug();
    });
    std::string loss;
    const auto start = std::chrono::steady_clock::now();
    while (loss.empty() && std::chrono::steady_clock::now() - start < std::chrono::seconds(10)) {
        loss = lossOf(*camera);
    }
    pull.join();
    CHECK(loss.find("No such device") !=
          std::string::npos);        // reported by the driver, not detected by silence
    CHECK(isPlainDepth(*held, 320)); // a frame outlives the camera's unplugging
    CHECK_FALSE(lossOf(*camera).empty());
    held.reset();
    // A camera with another serial number is not accepted.
    UvcCamera other({.serial = "OTHER"});
    other.plug();
    REQUIRE(waitForCamera());
    CHECK_FALSE(lossOf(*camera).empty());
    other.unplug();
    REQUIRE(waitForNoCamera());
    device->plug();
    REQUIRE(waitForCamera());
    readFrames(*camera, 3);
}

TEST_CASE("A silent stream is restarted, and is lost when that does not help") {
    PluggedCamera plugged({.colour = false});
    CameraRequest request = plugged.request();
    request.silence = 0.4;
    V4l2Camera camera(request);
    readFrames(camera, 2);
    plugged.device.depth().faults.silent = true;
    std::thread wake([&plugged] {
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        plugged.device.depth().faults.silent = false;
    });
    readFrames(camera, 2); // after a restart
    wake.join();
    plugged.device.depth().faults.silent = true;
    CHECK_THROWS_AS(readFrames(camera, 5), DeviceLost);
    plugged.device.depth().faults.silent = false;
    readFrames(camera, 1); // opened again
}

TEST_CASE("A silent colour stream with running depth is restarted once, not with each depth frame") {
    PluggedCamera plugged({});
    CameraRequest request = plugged.request();
    request.silence = 0.4;
    V4l2Camera camera(request);
    readFrames(camera, 2);
    plugged.device.colour().faults.silent = true;
    std::string loss;
    while (loss.empty()) {
        loss = lossOf(camera);
    }
    CHECK(loss.find("no frame for") != std::string::npos);
    CHECK(camera.restarts() == 1);
    CHECK(camera.skipped() > 5); // depth came all the time, and found no colour
    plugged.device.colour().faults.silent = false;
    readFrames(camera, 2); // opened again
}
