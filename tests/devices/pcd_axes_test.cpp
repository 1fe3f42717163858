// SPDX-License-Identifier: Apache-2.0
// Clouds whose points no camera could see.
#include "devices/pcd/pcd_camera.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

// A tilted wall, with its axes multiplied.
std::string turnedWall(double x, double y, double z, const std::string& viewpoint = "0 0 0 1 0 0 0") {
    std::string text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 9\nHEIGHT 7\n"
                       "VIEWPOINT " +
                       viewpoint + "\nPOINTS 63\nDATA ascii\n";
    for (int i = 0; i < 63; ++i) {
        const int row = i / 9;
        const double u = i % 9, v = row, depth = 1.0 + 0.05 * u;
        text += std::to_string(x * (u - 4.25) / 10.0 * depth) + " " +
                std::to_string(y * (v - 3.5) / 11.0 * depth) + " " + std::to_string(z * depth) + "\n";
    }
    return text;
}

} // namespace

TEST_CASE("A cloud behind its camera, or upside down or mirrored in all axes, is rejected in these words") {
    const TemporaryFolder folder;
    const auto refusal = [&](double x, double y, double z) {
        folder.write("a.pcd", turnedWall(x, y, z));
        return testing::refusalOf([&] { PcdCamera camera(folder.path() / "a.pcd", {}); });
    };
    const std::string behind = refusal(1.0, 1.0, -1.0), mirrored = refusal(-1.0, 1.0, 1.0);
    CAPTURE(behind);
    CAPTURE(mirrored);
    CHECK(behind.find("fan: all lie behind the camera if z is forward, and are mirrored or upside "
                      "down if z is backward (allowed: ") != std::string::npos);
    CHECK(mirrored.find("fan: they lie behind the camera or are mirrored or upside down in all axes that are "
                        "read (allowed: ") != std::string::npos);
    CHECK(refusal(1.0, 1.0, 1.0).empty());
    CHECK(refusal(1.0, -1.0, -1.0).empty());
}

TEST_CASE("That no camera has the lens of a cloud is among its warnings") {
    const TemporaryFolder folder;
    const auto warnings = [&](double x) {
        folder.write("a.pcd", turnedWall(x, 1.0, 1.0));
        return PcdCamera(folder.path() / "a.pcd", {}).warnings();
    };
    CHECK(warnings(1.0).empty());
    REQUIRE(warnings(2.0).size() == 1);
    CHECK(warnings(2.0)[0].find("they may be in another frame than their camera's") != std::string::npos);
}

TEST_CASE("A VIEWPOINT other than the identity has one warning, as the scene's pose counts") {
    const TemporaryFolder folder;
    const auto warnings = [&](const std::string& viewpoint) {
        folder.write("a.pcd", turnedWall(1.0, 1.0, 1.0, viewpoint));
        return PcdCamera(folder.path() / "a.pcd", {}).warnings();
    };
    for (const char* viewpoint : {"1 2 3 0.5 -0.5 0.5 -0.5", "0 0 0.5 1 0 0 0", "0 0 0 0.6 0 0 0.8"}) {
        CAPTURE(viewpoint);
        REQUIRE(warnings(viewpoint).size() == 1);
        CHECK(warnings(viewpoint)[0] ==
              "the pose in VIEWPOINT is not read: base_T_camera of the scene counts");
    }
    for (const char* none : {"0.0 0.0 0.0 1.0 0.0 0.0 -0.0", "0 0 0 0 0 0 1", "0 0 0 0 0 0 0", ""}) {
        CHECK(warnings(none).empty());
    }
}
