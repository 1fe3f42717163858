// SPDX-License-Identifier: Apache-2.0
// A live camera of ROS 2. Its driver is tests/ros2_talker. Waits have generous limits, and none is for a
// fixed time.
#include "devices/ros2/ros2_camera.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "tests/ros2/talker.h"
#include "tests/support/refusal.h"

#include <chrono>
#include <doctest/doctest.h>
#include <functional>
#include <thread>

using namespace fathom;

namespace {

const std::string kColour = ",colour=/camera/color/image_raw";

bool mentions(const std::vector<std::string>& lines, const std::string& part) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

// Reads frames until `seen` holds, at most a minute.
bool framesUntil(Ros2Camera& camera, const std::function<bool(const Frame*)>& seen) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
        try {
            const auto frame = camera.next();
            if (seen(&*frame)) {
                return true;
            }
        } catch (const DeviceLost&) {
            if (seen(nullptr)) {
                return true;
            }
        }
    }
    return false;
}

std::string refused(const Ros2Request& request) {
    return testing::refusalOf([&] { Ros2Camera camera(request); });
}

double nowMonotonic() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

TEST_CASE("A camera of ROS 2 gives depth, colour and lens as its driver publishes them") {
    Talker driver;
    Ros2Camera camera(requestCamera(kColour));
    const CameraInfo& info = camera.info();
    CHECK(info.depth.width == 8);
    CHECK(info.depth.height == 6);
    CHECK(info.depth.fx == 7.0);
    CHECK(info.depth.cx == 3.5);
    CHECK(info.hasColour);
    CHECK(info.registered);
    CHECK(info.metresPerUnit == 0.001);
    for (uint32_t i = 0; i < 5; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->index == i);
        CHECK((*frame)->depth.size() == 48);
        CHECK((*frame)->depth[47] == 500);
        CHECK(coloursOf(**frame)[47] == 0xff0000c8u);
        CHECK((*frame)->captureTime <= nowMonotonic());
    }
    CHECK(camera.live());
}

TEST_CASE("Depth in metres gets a unit that holds the scene's range") {
    Talker driver;
    driver.set("encoding", 1);
    Ros2Request request = requestCamera();
    request.options.farthest = 3.0;
    Ros2Camera camera(request);
    CHECK_FALSE(camera.info().hasColour);
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] * camera.info().metresPerUnit == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("A transform that was published before the camera was opened relates colour to depth") {
    Talker driver;
    driver.set("tf", 1);
    Ros2Camera camera(requestCamera(kColour));
    CHECK_FALSE(camera.info().registered);
    CHECK(camera.info().colourTdepth.position.x == doctest::Approx(-0.025));
}

TEST_CASE("A camera whose driver starts late is found") {
    std::optional<Talker> driver;
    std::thread late([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        driver.emplace();
    });
    Ros2Camera camera(requestCamera(kColour));
    late.join();
    CHECK(camera.next().has_value());
}

TEST_CASE("Without a driver the refusal names topic, domain and network, and what else is published") {
    Ros2Request request = requestCamera();
    request.wait = 0.2;
    const std::string nobody = refused(request);
    CHECK(nobody.find("/camera/depth/image_rect_raw") != std::string::npos);
    CHECK(nobody.find("domain " + std::to_string(testDomain()) + " on network lo") != std::string::npos);

    Talker driver;
    driver.set("info", 0);
    request.wait = 6.0;
    const std::string lens = refused(request);
    CHECK(lens.find("camera_info") != std::string::npos);
    CHECK(lens.find("/camera/depth/image_rect_raw (sensor_msgs/msg/Image)") != std::string::npos);
}

TEST_CASE("A killed driver is reported as lost, and its successor is used") {
    auto driver = std::make_unique<Talker>();
    Ros2Request request = requestCamera(kColour);
    request.silence = 1.5;
    Ros2Camera camera(request);
    REQUIRE(camera.next());
    driver.reset();
    CHECK(framesUntil(camera, [](const Frame* frame) { return frame == nullptr; }));
    Talker successor;
    successor.set("value", 700);
    CHECK(framesUntil(camera,
                      [](const Frame* frame) { return frame != nullptr && (*frame)->depth[0] == 700; }));
}

TEST_CASE("A driver that ends before the first frame is reported with the time since the camera was opened") {
    auto driver = std::make_unique<Talker>();
    Ros2Request request = requestCamera(",colour=none"); // so that no image waits for another
    request.silence = 0.5;
    Ros2Camera camera(request);
    const double opened = nowMonotonic();
    driver.reset();
    std::string message;
    while (message.empty()) { // frames that were sent meanwhile come first
        try {
            camera.next();
        } catch (const DeviceLost& e) {
            message = e.what();
        }
    }
    const std::string before = "no depth image for ";
    REQUIRE(message.find(before) != std::string::npos);
    CHECK(std::stod(message.substr(message.find(before) + before.size())) <= nowMonotonic() - opened + 1.0);
}

TEST_CASE("Messages that end early are counted and named once, and frames continue") {
    Talker driver;
    Ros2Camera camera(requestCamera());
    REQUIRE(camera.next());
    driver.set("on", 0); // the broken messages' writer is another one, heard when the first is silent
    driver.set("broken", 1);
    CHECK(framesUntil(camera, [&](const Frame*) { return camera.skipped() >= 3; }));
    CHECK(mentions(camera.warnings(), "truncated"));
    CHECK(camera.warnings().size() == 1);
    driver.set("broken", 0);
    driver.set("on", 1);
    CHECK(framesUntil(camera, [](const Frame* frame) { return frame != nullptr; }));
}

TEST_CASE("An image that claims more rows than it has, or another encoding, is skipped and named") {
    Talker driver;
    Ros2Camera camera(requestCamera());
    REQUIRE(camera.next());
    driver.set("claim", 4'000'000'000.0);
    CHECK(framesUntil(camera, [&](const Frame*) { return camera.skipped() >= 3; }));
    CHECK(mentions(camera.warnings(), "size or encoding differs"));
    driver.set("claim", 0);
    driver.set("encoding", 2);
    const uint32_t before = camera.skipped();
    CHECK(framesUntil(camera, [&](const Frame*) { return camera.skipped() >= before + 3; }));
    driver.set("encoding", 0);
    CHECK(framesUntil(camera, [](const Frame* frame) { return frame != nullptr; }));
}

TEST_CASE("An encoding that is not read is refused with the encodings that are") {
    Talker driver;
    driver.set("encoding", 2);
    Ros2Request request = requestCamera();
    request.wait = 6.0;
    const std::string why = refused(request);
    CHECK(why.find("64FC1") != std::string::npos);
    CHECK(why.find("16UC1") != std::string::npos);
}

TEST_CASE("A clock that jumps back costs a few frames, and capture times never go back") {
    Talker driver;
    Ros2Camera camera(requestCamera());
    double last = 0.0;
    const auto ordered = [&](const Frame& frame) {
        const bool fine = frame->captureTime >= last && frame->captureTime <= nowMonotonic();
        last = frame->captureTime;
        return fine;
    };
    REQUIRE(ordered(*camera.next()));
    driver.set("shift", -100.0);
    uint32_t after = 0;
    CHECK(framesUntil(camera, [&](const Frame* frame) {
        after +=
            frame != nullptr && ordered(*frame) && camera.skipped() >= LiveStamps::kMaxBackward - 1 ? 1 : 0;
        return after >= 5;
    }));
    CHECK(mentions(camera.warnings(), "not later than the one before"));
}

TEST_CASE("Messages of a second driver of the same topics are ignored and counted") {
    Talker first;
    Ros2Camera camera(requestCamera());
    REQUIRE(camera.next());
    Talker second;
    second.set("value", 900);
    bool mixed = false;
    CHECK(framesUntil(camera, [&](const Frame* frame) {
        mixed = mixed || (frame != nullptr && (*frame)->depth[0] != 500);
        return camera.foreign() >= 10;
    }));
    CHECK_FALSE(mixed);
}

TEST_CASE("Depth images are skipped while colour is missing, and are paired again with its return") {
    Talker driver;
    Ros2Camera camera(requestCamera(kColour));
    REQUIRE(camera.next());
    driver.set("colour", 0);
    CHECK(framesUntil(camera, [&](const Frame* frame) { return frame == nullptr && camera.skipped() >= 3; }));
    driver.set("colour", 1);
    CHECK(framesUntil(camera, [](const Frame* frame) { return frame != nullptr; }));
    CHECK(mentions(camera.warnings(), "no colour image"));
}

TEST_CASE("A moving camera has the pose that tf gives at the stamp of its image") {
    Talker driver;
    driver.set("moving", 1);
    Ros2Camera camera(requestCamera(",frame=base"));
    CHECK_FALSE(camera.info().poseless);
    const auto utc = std::chrono::system_clock::now().time_since_epoch();
    const double ahead = std::chrono::duration<double>(utc).count() - nowMonotonic();
    for (int i = 0; i < 5; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        REQUIRE((*frame)->baseTcamera);
        const double expected = 0.5 + 0.1 * std::fmod((*frame)->captureTime + ahead, 1000.0);
        CHECK(std::abs((*frame)->baseTcamera->position.x - expected) < 0.01); // the machine may be busy
    }
    driver.set("moving", 0);
    CHECK(framesUntil(camera, [&](const Frame* frame) { return frame == nullptr && camera.skipped() >= 3; }));
    CHECK(mentions(camera.warnings(), "no pose at its stamp: /tf of 'wrist' ends before it"));
    CHECK(camera.warnings().size() == 1);
    driver.set("moving", 1);
    CHECK(framesUntil(camera, [](const Frame* frame) { return frame != nullptr; }));
    CHECK_FALSE(Ros2Camera(requestCamera()).next().value()->baseTcamera);
}

TEST_CASE("A camera to which no transforms lead is refused with both frames") {
    Talker driver;
    driver.set("moving", 1);
    Ros2Request request = requestCamera(",frame=world");
    request.wait = 6.0;
    CHECK(refused(request).find("no transforms between 'depth_frame' and 'world'") != std::string::npos);
}
