// SPDX-License-Identifier: Apache-2.0
// A RealSense D4xx without librealsense: its tables through the kernel's UVC driver.
#include "tests/vm/camera/live_camera.h"

using namespace fathom;
using namespace fathom::vm;
namespace sim = fathom::vm::simulated_realsense;

TEST_CASE("A RealSense tells its lenses, depth unit and extrinsics over its extension unit") {
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
    CHECK(info.colourTdepth.position.x == doctest::Approx(0.001 * sim::kColourShiftMillis).epsilon(1e-6));
    for (int i = 0; i < 5; ++i) {
        const auto frame = camera->next();
        REQUIRE(frame);
        CHECK(isPlainDepth(*frame, 320));
    }
}

TEST_CASE("A RealSense whose tables cannot be had is refused, saying why") {
    UvcCamera device({.realSense = true});
    device.plug();
    REQUIRE(waitForCamera());
    device.wrongChecksum = true;
    CHECK(refusalOf("v4l2:auto,size=320x240").find("calibration table 25: wrong checksum") !=
          std::string::npos);
    device.wrongChecksum = false;
    device.refuseTables = true;
    CHECK(refusalOf("v4l2:auto,size=320x240").find("RealSense command 21: refused with -1") !=
          std::string::npos);
    device.refuseTables = false;
    device.stallMailbox = true;
    CHECK(refusalOf("v4l2:auto,size=320x240").find("extension unit 3, control 1") != std::string::npos);
    device.stallMailbox = false;
    device.mailboxDelayMs = 300; // late, but within the kernel's own limit
    CHECK(refusalOf("v4l2:auto,size=320x240").empty());
}
