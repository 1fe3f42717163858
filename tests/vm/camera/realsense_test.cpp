// SPDX-License-Identifier: Apache-2.0
// A RealSense D4xx without librealsense: its tables through the kernel's UVC driver.
#include "tests/vm/camera/live_camera.h"

#include <array>
#include <atomic>

using namespace fathom;
using namespace fathom::vm;
namespace sim = fathom::vm::simulated_realsense;

TEST_CASE("A RealSense reports its lenses, depth unit and extrinsics through its extension unit") {
    UvcCamera device({.realSense = true});
    device.plug();
    REQUIRE(waitForCamera());
    const auto camera = openLive(",size=320x240");
    const CameraInfo& info = camera->info();
    CHECK(info.depth.fx == doctest::Approx(sim::kFocal).epsilon(1e-7));
    CHECK(info.depth.fy == doctest::Approx(sim::kFocal + 1.0).epsilon(1e-7));
    CHECK(info.depth.cx == doctest::Approx(sim::kCentreX).epsilon(1e-7));
    CHECK(info.depth.cy == doctest::Approx(sim::kCentreY).epsilon(1e-7));
    CHECK(info.metresPerUnit == doctest::Approx(0.0005).epsilon(1e-12));
    CHECK_FALSE(info.registered);
    // 4:3 cut from 16:9: the horizontal figures grow by 4/3.
    CHECK(info.colour.fx == doctest::Approx(0.5 * sim::kColourFx * 4.0 / 3.0 * 320).epsilon(1e-6));
    CHECK(info.colour.cx == doctest::Approx(0.5 * (1.0 + sim::kColourCx * 4.0 / 3.0) * 320).epsilon(1e-6));
    CHECK(info.colour.fy == doctest::Approx(0.5 * sim::kColourFy * 240).epsilon(1e-6));
    CHECK(info.colour.cy == doctest::Approx(0.5 * (1.0 + sim::kColourCy) * 240).epsilon(1e-6));
    // The table maps colour to depth: p_depth = R p_colour - shift. So (0.5, 0.25, 2) of the depth camera is
    // R^T (0.51475, 0.2475, 2.00325); R's columns are (2, 2, -1), (-1, 2, 2), (2, -1, 2), each over 3.
    const dvec3 seen = info.colourTdepth.apply({0.5, 0.25, 2.0});
    CHECK(seen.x == doctest::Approx((2 * 0.51475 + 2 * 0.2475 - 2.00325) / 3).epsilon(1e-6));
    CHECK(seen.y == doctest::Approx((-0.51475 + 2 * 0.2475 + 2 * 2.00325) / 3).epsilon(1e-6));
    CHECK(seen.z == doctest::Approx((2 * 0.51475 - 0.2475 + 2 * 2.00325) / 3).epsilon(1e-6));
    for (int i = 0; i < 5; ++i) {
        const auto frame = camera->next();
        REQUIRE(frame);
        CHECK(isPlainDepth(*frame, 320));
    }
}

TEST_CASE("A RealSense that reports the age of a frame has its capture time at the start of exposure") {
    constexpr uint32_t kLatency = 500000;         // [us] longer than any delivery here
    std::array<std::atomic<double>, 256> drawn{}; // [s] start of sending frame n
    const auto now = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    const auto paint = plainDepth(320, 240);
    UvcCamera device({.colour = false, .realSense = true, .paintDepth = [&](uint32_t n, Bytes& image) {
                          paint(n, image);
                          drawn[n % drawn.size()] = now();
                      }});
    device.plug();
    REQUIRE(waitForCamera(false));
    for (const uint32_t latency : {kLatency, 0u}) {
        CAPTURE(latency);
        device.depth().pipeLatencyMicros = latency;
        const auto camera = openLive(",size=320x240");
        for (int i = 0; i < 10; ++i) {
            const auto frame = camera->next();
            REQUIRE(frame);
            const double came = (*frame)->captureTime + 1e-6 * latency; // the driver's stamp
            CHECK(came >= drawn[(*frame)->depth[0] % drawn.size()].load() - 1e-4);
            CHECK(came <= now());
        }
        CHECK(camera->exposureStamps() == (latency > 0 ? 10 : 0));
        CHECK((camera->description().find("which reports the start of exposure") != std::string::npos) ==
              (latency > 0));
    }
}

TEST_CASE("A RealSense whose tables cannot be read is rejected with the reason") {
    UvcCamera device({.realSense = true});
    device.plug();
    REQUIRE(waitForCamera());
    device.wrongChecksum = true;
    CHECK(cameraRefusal("v4l2:auto,size=320x240").find("calibration table 25: wrong checksum") !=
          std::string::npos);
    device.wrongChecksum = false;
    device.refuseTables = true;
    CHECK(cameraRefusal("v4l2:auto,size=320x240").find("RealSense command 21: refused with -1") !=
          std::string::npos);
    device.refuseTables = false;
    device.stallMailbox = true;
    CHECK(cameraRefusal("v4l2:auto,size=320x240").find("extension unit 3, control 1") != std::string::npos);
    device.stallMailbox = false;
    device.mailboxDelayMs = 300; // late, but within the kernel's limit
    CHECK(cameraRefusal("v4l2:auto,size=320x240").empty());
}

TEST_CASE("A RealSense without a colour calibration continues with depth and rejects requested colour") {
    UvcCamera device({.realSense = true, .colourTable = false});
    device.plug();
    REQUIRE(waitForCamera());
    {
        const auto camera = openLive(",size=320x240");
        CHECK_FALSE(camera->info().hasColour);
        CHECK(camera->info().registered);
        CHECK(camera->info().depth.fx == doctest::Approx(sim::kFocal).epsilon(1e-7));
        for (int i = 0; i < 5; ++i) {
            const auto frame = camera->next();
            REQUIRE(frame);
            CHECK(isPlainDepth(*frame, 320));
            CHECK((*frame)->colourBytes().empty());
        }
        CHECK(camera->skipped() == 0); // nothing waits for a colour frame
        device.unplug();
        CHECK_FALSE(lossOf(*camera).empty());
        REQUIRE(waitForNoCamera());
        device.plug();
        REQUIRE(waitForCamera());
        CHECK(camera->next()); // found again, without its colour
    }
    CHECK(cameraRefusal("v4l2:auto,size=320x240,colour_format=YUYV").find("RealSense command 21: refused") !=
          std::string::npos);
    const IntrinsicsFile lens(320, 240);
    CHECK(openLive(",intrinsics=" + lens.path().string())->info().hasColour); // a user's own calibration
}
