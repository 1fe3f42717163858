// SPDX-License-Identifier: Apache-2.0
// What a camera states about itself: absurd lenses, and gates that no point of it can pass. Keys of a class
// that its role does not use.
#include "engine/scene/camera_limits.h"
#include "engine/scene/dead_gates.h"
#include "engine/scene/plan.h"
#include "tests/scene/scene_file.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <string>
#include <vector>

using namespace fathom;

namespace {

CameraInfo camera() {
    CameraInfo info;
    info.depth = {.width = 640, .height = 480, .fx = 525, .fy = 525, .cx = 320, .cy = 240};
    info.colour = info.depth;
    return info;
}

std::string fault(const std::function<void(CameraInfo&)>& change) {
    CameraInfo info = camera();
    change(info);
    return testing::refusalOf([&] { checkCamera(info, "recorded here"); });
}

std::string dead(const std::string& fixture, const std::function<void(CameraInfo&)>& change = {}) {
    CameraInfo info = camera();
    if (change) {
        change(info);
    }
    const SceneFile file("fixtures: [{name: valve, role: forbidden, " + fixture + "}]\n" + kTool);
    std::string all;
    for (const std::string& sentence : deadGates(loadScene(file.path()), info)) {
        all += sentence + "\n";
    }
    return all;
}

// How the plan rejects an image of this size on a device with these limits.
std::string tooLarge(const std::string& keys, uint32_t width, uint32_t height, uint32_t texels,
                     uint64_t bytes) {
    CameraInfo info = camera();
    info.depth.width = width, info.depth.height = height;
    DeviceFacts device;
    device.name = "Small GPU";
    device.kind = DeviceKind::Integrated;
    device.maxTexels = texels;
    device.maxStorageBufferBytes = bytes;
    const SceneFile file(keys + kTool);
    return testing::refusalOf([&] { makePlan(loadScene(file.path()), info, 1, device); });
}

} // namespace

TEST_CASE("Lenses of absurd or non-finite numbers are rejected with source, field, value and range") {
    CHECK(fault([](CameraInfo&) {}) == "");
    CHECK(fault([](CameraInfo& c) { c.depth.fx = 1e300; }) ==
          "recorded here: depth fx: 1e+300 (allowed: a number from 0.001 to 64000)");
    for (const double bad : {1e300, 1e-300, 0.0, -525.0, std::nan(""), HUGE_VAL, 1e6}) {
        CAPTURE(bad);
        CHECK(fault([&](CameraInfo& c) { c.depth.fx = bad; }).find("depth fx: ") != std::string::npos);
        CHECK(fault([&](CameraInfo& c) { c.depth.fy = bad; }).find("depth fy: ") != std::string::npos);
        CHECK(fault([&](CameraInfo& c) { c.metresPerUnit = bad == 1e6 ? 2.0 : bad; }) != "");
    }
    for (const double bad : {1e300, -1e9, std::nan("")}) {
        CAPTURE(bad);
        CHECK(fault([&](CameraInfo& c) { c.depth.cx = bad; }).find("within 89 degrees") != std::string::npos);
        CHECK(fault([&](CameraInfo& c) { c.depth.cy = bad; }).find("within 89 degrees") != std::string::npos);
        CHECK(fault([&](CameraInfo& c) { c.depth.distortion[2] = bad == -1e9 ? 1e9 : bad; }) != "");
        const auto colour = [&](CameraInfo& c) { c.registered = false, c.colour.fx = std::abs(bad); };
        CHECK(fault(colour).find("colour fx: ") != std::string::npos);
        const auto apart = [&](CameraInfo& c) { c.registered = false, c.colourTdepth.position.x = bad; };
        CHECK(fault(apart).find("colour_T_depth: ") != std::string::npos);
        CHECK(fault([&](CameraInfo& c) { c.beam = BeamSigma{bad, 0.0, 0.01}; }) != "");
        CHECK(fault([&](CameraInfo& c) { c.sigma = bad; }) != "");
    }
}

TEST_CASE("A lens that folds its image is rejected, for depth and for colour") {
    const auto folds = [](CameraInfo& c) { c.depth.fx = c.depth.fy = 450, c.depth.distortion[0] = -1.0; };
    CHECK(fault(folds) == "recorded here: depth distortion: -1 0 0 0 0 (allowed: coefficients that can be "
                          "inverted over the whole image)");
    const auto colour = [](CameraInfo& c) { c.registered = false, c.colour.distortion[3] = 5.0; };
    CHECK(fault(colour).find("colour distortion: 0 0 0 5 0 ") != std::string::npos);
    CHECK(fault([](CameraInfo& c) { c.depth.distortion = {0.1, -0.2, 0.001, 0.001, 0.05}; }) == "");
}

TEST_CASE("A class that no point can pass is named with its cause, and others are not") {
    const auto colourless = [](CameraInfo& c) { c.hasColour = false; };
    CHECK(dead("radius: 0.04") == "");
    CHECK(dead("hue: [345, 20], saturation: [0.4, 1], lightness: [0.1, 0.9]") == "");
    CHECK(dead("radius: 0.04", colourless) == "");
    CHECK(dead("hue: [345, 20]", colourless).find("'valve' can have no point: it has a colour gate") !=
          std::string::npos);
    CHECK(dead("hue: [345, 20], saturation: [0, 0]").find("has no hue") != std::string::npos);
    CHECK(dead("hue: [345, 20], lightness: [0, 0]").find("black or white") != std::string::npos);
    CHECK(dead("saturation: [0.5, 1], lightness: [1, 1]").find("black or white") != std::string::npos);
    CHECK(dead("lightness: [1, 1]") == "");
    CHECK(dead("range: [4, 6]").find("range of 4 to 6 m lies outside") != std::string::npos);
    CHECK(dead("range: [0, 0.05]").find("lies outside") != std::string::npos);
    CHECK(dead("range: [3.2, 6]") == ""); // the corners of the image reach farther than camera.far
    CHECK(dead("radius: 0.04", [](CameraInfo& c) { c.metresPerUnit = 1.0; }) ==
          "a depth unit of 1 m leaves 3 depth values between camera.near 0.1 and camera.far 3 m\n");
    CHECK(dead("radius: 0.04", [](CameraInfo& c) { c.metresPerUnit = 1e-6; }).find("leaves 0 depth values") !=
          std::string::npos);
}

TEST_CASE("Keys of the other role are named per class, unless they equal the defaults") {
    const auto notes = [](const std::string& row) {
        const SceneFile file("fixtures: [{name: valve, " + row + "}]\n" + kTool);
        return unusedKeys(loadScene(file.path()));
    };
    CHECK(notes("role: forbidden, radius: 0.03, standoff: 0, min_count: 50, trim: 0, largest_part: false")
              .empty());
    CHECK(notes("role: guidance, radius: 0.04, standoff: 0.1, min_count: 10, trim: 0.2").empty());
    CHECK(notes("role: guidance, radius: 0.03") ==
          std::vector<std::string>{
              "fixture 'valve': radius: no effect with role guidance, only with forbidden"});
    CHECK(notes("role: forbidden, standoff: 0.1, quat_xyzw: [1, 0, 0, 0], min_count: 10, largest_part: true, "
                "trim: 0.2") ==
          std::vector<std::string>{"fixture 'valve': standoff, quat_xyzw, min_count, largest_part, trim: no "
                                   "effect with role forbidden, only with guidance"});
}

TEST_CASE("Hues that are shares of 1 or one number are named, and ranges of degrees are not") {
    const auto notes = [](const std::string& gate) {
        const SceneFile file("fixtures: [{name: valve, role: forbidden, " + gate + "}]\n" + kTool);
        std::string all;
        for (const std::string& note : hueNotes(loadScene(file.path()))) {
            all += note + "\n";
        }
        return all;
    };
    CHECK(
        notes("hue: [0.95, 0.05]") ==
        "fixture 'valve': hue [0.95, 0.05] is in degrees, 0 to 360; if it is a share of 1, give [342, 18]\n");
    CHECK(notes("hue: [0, 1]") != "");
    CHECK(notes("hue: [120, 120]") == "fixture 'valve': hue [120, 120] passes one hue only, not a range\n");
    CHECK(notes("hue: [360, 0]") == "fixture 'valve': hue [360, 0] wraps through 0 and passes 0 degrees "
                                    "only; [0, 360] passes the others\n");
    CHECK(notes("hue: [359.75, 0]") != "");
    for (const char* good :
         {"hue: [359, 0]", "hue: [0, 360]", "hue: [345, 20]", "hue: [0, 20]", "hue: [359, 1]",
          "hue: [0.5, 12]", "radius: 0.04", "saturation: [0.5, 1]", "lightness: [0, 1]"}) {
        CAPTURE(good);
        CHECK(notes(good) == "");
    }
}

TEST_CASE("An image that a device cannot read is rejected with the decimation that makes it small enough") {
    constexpr uint32_t kTexels = 1u << 16; // the least that Vulkan guarantees
    constexpr uint64_t kBytes = 1u << 27;
    const std::string all = "fixtures: [{name: all, role: forbidden}]\n";
    CHECK(tooLarge(all, 640, 480, kTexels, kBytes) ==
          "camera: image size: 640x480 (allowed: at most 65536 pixels in squares of 16x16 on Small GPU, for "
          "example with camera.decimation: 3)");
    CHECK(tooLarge(all, 256, 256, kTexels, kBytes) == "");
    CHECK(tooLarge(all, 257, 256, kTexels, kBytes) != "");
    CHECK(tooLarge(all, 3840, 2160, kTexels, kBytes).ends_with("on Small GPU)")); // not even an eighth fits
    // The size is the decimated one.
    CHECK(tooLarge("camera: {decimation: 2}\n" + all, 320, 240, kTexels, kBytes).ends_with("decimation: 4)"));
    // Estimates take two texels per pixel.
    const std::string memory = "camera: {static: true}\nfilter: {memory: 8}\n";
    CHECK(tooLarge(memory + all, 256, 256, kTexels, kBytes) != "");
    CHECK(tooLarge("hold_s: 0\n" + all, 640, 480, 1u << 27, 307200 * 16) == "");
    CHECK(tooLarge("hold_s: 0\n" + all, 640, 480, 1u << 27, 307200 * 16 - 1) != "");
    const std::string box = "fixtures: [{name: box, role: forbidden, shape: box, base_T_shape: {xyz: [0, 0, "
                            "1]}, size: [1, 1, 1]}]\n";
    CHECK(tooLarge(box, 640, 480, kTexels, kBytes) == ""); // no pass reads an image
}
