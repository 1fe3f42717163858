// SPDX-License-Identifier: Apache-2.0
// Messages about cameras that the library cannot use, and about those that protect nothing.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <doctest/doctest.h>
#include <mutex>
#include <string>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A camera model that cannot be used is rejected by one line with its name, field and value") {
    const auto fault = [](void (*change)(CameraModel&)) {
        CameraModel model = smallCamera();
        model.name = "arm\n\x1b[31m";
        change(model);
        try {
            const Lockstep made(wallScene(), model, startAt(0.5));
        } catch (const BadInput& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    CHECK(fault([](CameraModel&) {}) == "");
    const std::string unit = fault([](CameraModel& m) { m.metresPerUnit = 0.0; });
    CHECK(unit.find("metresPerUnit: 0 (allowed: 1e-7 to 1)") != std::string::npos);
    CHECK(fault([](CameraModel& m) { m.depth.fx = 0.0; }).find("depth: 80x60, fx 0 (allowed: ") !=
          std::string::npos);
    CHECK(std::ranges::none_of(unit, [](char c) { return c == '\n' || c == '\x1b'; }));
    const auto is = [&](void (*change)(CameraModel&), const char* text) {
        CHECK(fault(change) == std::string("camera arm  [31m: ") + text);
    };
    is([](CameraModel& m) { m.metresPerUnit = 1e300; }, "metresPerUnit: 1e+300 (allowed: 1e-7 to 1)");
    is([](CameraModel& m) { m.metresPerUnit = 1e-8; }, "metresPerUnit: 1e-08 (allowed: 1e-7 to 1)");
    is([](CameraModel& m) { m.depth.height = 0; }, "depth: 80x0 (allowed: a width and a height above 0)");
    is([](CameraModel& m) { m.depth.fy = 0.0; }, "depth: 80x60, fy 0 (allowed: a positive number of pixels)");
    is([](CameraModel& m) { m.depth.fx = HUGE_VAL; },
       "depth: 80x60, fx inf (allowed: a positive number of pixels)");
    is([](CameraModel& m) { m.depth.cy = HUGE_VAL; },
       "depth: 80x60, cy inf (allowed: a finite number of pixels)");
    is([](CameraModel& m) { m.depth.distortion[3] = -HUGE_VAL; },
       "depth: 80x60, distortion[3] -inf (allowed: a finite number)");
    is([](CameraModel& m) { (m.colour = m.depth)->cx = HUGE_VAL; },
       "colour: 80x60, cx inf (allowed: a finite number of pixels)");
    CHECK(fault([](CameraModel& m) { m.colourFormat = static_cast<ColourFormat>(17); }).find("Format: 17 ") !=
          std::string::npos);
    CHECK(fault([](CameraModel& m) { m.depthFormat = static_cast<DepthFormat>(-1); }).find("Format: -1 ") !=
          std::string::npos);
}

TEST_CASE("A frame that lockstep cannot use is rejected by one line with camera, field, value and limits") {
    CameraModel model = smallCamera();
    model.colourFormat = ColourFormat::Rgba;
    Lockstep lockstep(wallScene(), model, startAt(0.5));
    const Wall wall;
    const std::vector<std::uint32_t> colour(80 * 60, 0);
    const auto fault = [&](auto&& change) {
        Frame frame = wall.at(1);
        frame.colour = colour.data();
        change(frame);
        try {
            lockstep.process(frame);
        } catch (const BadInput& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    CHECK(fault([](Frame&) {}) == "");
    CHECK(fault([](Frame& f) { f.depth = nullptr; }) ==
          "camera camera: frame.depth: null (allowed: an image aligned to 2 bytes)");
    CHECK(fault([](Frame& f) { f.colour = nullptr; }) ==
          "camera camera: frame.colour: null (allowed: an image aligned to 4 bytes)");
    CHECK(fault([](Frame& f) { f.colour = static_cast<const std::byte*>(f.colour) + 1; }) ==
          "camera camera: frame.colour: not aligned (allowed: an image aligned to 4 bytes)");
    CHECK(
        fault([](Frame& f) { f.baseTcamera.position[1] = HUGE_VAL; }) ==
        "camera camera: frame.baseTcamera: position 0 inf 0, rotation 1 0 0 0 (allowed: a finite pose within "
        "1000 km, whose quaternion is not zero)");
}

TEST_CASE("A pose between the lenses protects the same whatever the length of its quaternion") {
    const Scene red = Scene::fromText("fixtures: [{ name: red, role: forbidden, hue: [345, 20], saturation: "
                                      "[0.4, 1], radius: 0.04 }]\nerror_budget: 0\n"
                                      "tool: { spheres: [[0, 0, 0, 0.01]] }\n");
    std::vector<std::uint8_t> colour(80 * 60 * 3, 90);
    for (size_t pixel = 0; pixel < 80 * 60; ++pixel) {
        if (pixel % 80 < 40) {
            colour[3 * pixel] = 200, colour[3 * pixel + 1] = colour[3 * pixel + 2] = 20;
        }
    }
    const auto spheresOf = [&](double length) {
        CameraModel model = smallCamera();
        model.colour = model.depth;
        model.colourFormat = ColourFormat::Rgb;
        model.colourTdepth.rotation = {length * std::cos(0.09), 0.0, length * std::sin(0.09), 0.0};
        Lockstep lockstep(red, model, startAt(0.5));
        const Wall wall;
        Frame frame = wall.at(1);
        frame.colour = colour.data();
        lockstep.process(frame);
        Regions regions;
        return lockstep.regions(regions) ? regions.spheres.size() : size_t{0};
    };
    const size_t spheres = spheresOf(1.0);
    CHECK(spheres > 0);
    for (const double length : {2.0, 0.5, 1e200, 1e-200}) {
        CAPTURE(length);
        CHECK(spheresOf(length) == spheres);
    }
}

TEST_CASE("Depth in metres is protected up to camera.far, and in units of 0.1 mm if they reach that far") {
    const auto regionsOf = [](const std::string& farZ, float metres, bool floats) {
        const Scene scene = Scene::fromText("camera: { near: 0.1, far: " + farZ +
                                            " }\nerror_budget: 0\n"
                                            "fixtures: [{ name: wall, role: forbidden, radius: 0.5 }]\n"
                                            "tool: { spheres: [[0, 0, 0, 0.01]] }\n");
        CameraModel model = smallCamera();
        model.depthFormat = floats ? DepthFormat::Metres : DepthFormat::Uint16;
        model.metresPerUnit = 0.0001;
        Lockstep lockstep(scene, model, startAt(0.05));
        const std::vector<float> depth(80 * 60, metres);
        const std::vector<std::uint16_t> raw(80 * 60, static_cast<std::uint16_t>(1e4f * metres + 0.5f));
        Frame frame;
        frame.depth = floats ? static_cast<const void*>(depth.data()) : raw.data();
        frame.stamp = 1;
        lockstep.process(frame);
        Regions regions;
        lockstep.regions(regions);
        return regions;
    };
    for (const auto& [limit, metres] : {std::pair("10", 9.99f), {"100", 99.0f}, {"10000", 9990.0f}}) {
        const char* const farZ = limit; // CAPTURE needs a variable
        const Regions regions = regionsOf(farZ, metres, true);
        CAPTURE(farZ);
        REQUIRE_FALSE(regions.spheres.empty());
        const double z = regions.origin[2] + double{regions.spheres.front().centre[2]};
        CHECK(z == doctest::Approx(metres).epsilon(1e-4));
    }
    CHECK(regionsOf("100", 101.0f, true).spheres.empty());
    for (const auto& [limit, metres] : {std::pair("3", 0.61237f), {"6.5535", 6.5535f}}) {
        const char* const farZ = limit;
        const auto floats = regionsOf(farZ, metres, true).spheres,
                   raw = regionsOf(farZ, metres, false).spheres;
        CAPTURE(farZ);
        REQUIRE_FALSE(raw.empty());
        REQUIRE(floats.size() == raw.size());
        for (size_t i = 0; i < raw.size(); ++i) {
            CHECK(floats[i].centre == raw[i].centre);
            CHECK(floats[i].radius == raw[i].radius);
        }
    }
}

TEST_CASE("A camera that protects nothing is named in the log: wrong unit, no depth, no colour") {
    std::mutex mutex;
    std::string lines;
    const auto has = [&](const char* text) {
        const std::lock_guard lock(mutex);
        return lines.find(text) != std::string::npos;
    };
    setLogCallback([&](LogLevel level, std::string_view line) {
        const std::lock_guard lock(mutex);
        lines += level == LogLevel::Warning ? std::string(line) + "\n" : "";
    });
    // right, rows: pixels at 0.6 m in the upper left corner
    const auto play = [](const Scene& scene, std::uint16_t depth, long right = 0, long rows = 1) {
        Lockstep lockstep(scene, smallCamera(), startAt(0.5));
        Wall wall;
        std::ranges::fill(wall.depth, depth);
        for (long row = 0; row < rows; ++row) {
            std::fill_n(wall.depth.begin() + 80 * row, right, std::uint16_t{600});
        }
        for (const Nanoseconds stamp : {1'000'000'000, 1'500'000'000, 2'000'000'000}) {
            lockstep.process(wall.at(stamp));
        }
    };
    play(wallScene(), 600);
    CHECK(lines.empty());
    play(wallScene(), 6000, 6, 5); // a small object in front of a far room
    CHECK_FALSE(has("camera: "));
    play(wallScene(), 6000); // a unit of 0.1 mm, said to be 1 mm
    CHECK(has("camera: no depth of the first second is between camera.near 0.1 m and camera.far 3 m: nothing "
              "is protected; it is 6 to 6 m, so check metresPerUnit"));
    for (const auto& [right, rows] : {std::pair(24, 1), {1, 24}}) { // at the edges of objects
        lines.clear();
        play(wallScene(), 6000, right, rows);
        CHECK(has("camera: only 0.5 % of the depth of the first second is between camera.near 0.1 m and "
                  "camera.far 3 m: hardly anything is protected; it is 0.6 to 6 m, so check metresPerUnit"));
    }
    play(wallScene(), 0);
    CHECK(has("no depth in the first second"));
    {
        Engine engine(wallScene(), smallCamera());
        CameraPort camera = engine.camera();
        Wall far;
        std::ranges::fill(far.depth, std::uint16_t{7000});
        CHECK(eventually(
            [&] { return camera.submit(far.at(now())) == SubmitStatus::Accepted && has("it is 7 to 7 m"); }));
    }
    const Scene red = Scene::fromText("fixtures: [{ name: red, role: forbidden, hue: [345, 20] }]\n"
                                      "tool: { spheres: [[0, 0, 0, 0.01]] }\n");
    const Engine engine(red, smallCamera());
    CHECK(has("'red' can have no point: it has a colour gate, and the camera has no colour"));
    setLogCallback(nullptr);
}
