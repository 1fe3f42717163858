// SPDX-License-Identifier: Apache-2.0
// Organised clouds in files of messages. Those of the corpus were written by the npm packages @mcap/core and
// @foxglove/rosmsg2-serialization: three clouds of 9 x 7 points, a tilted wall from 1 m on, 0.1 m farther
// each, seen with fx 10, fy 11, cx 4.25, cy 3.5; red; without the first point.
#include "devices/bag/open_bag.h"
#include "tests/devices/played_bag.h"
#include "tests/realtime/listening.h"
#include "tests/support/refusal.h"

#include <spdlog/spdlog.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::filesystem::path kClouds = "tests/fuzz/corpus/mcap";

void checkWalls(Camera& camera) {
    CHECK(camera.info().depth.fx == doctest::Approx(10.0).epsilon(1e-3));
    CHECK(camera.info().depth.fy == doctest::Approx(11.0).epsilon(1e-3));
    CHECK(camera.info().depth.cx == doctest::Approx(4.25).epsilon(1e-3));
    CHECK(camera.info().depth.cy == doctest::Approx(3.5).epsilon(1e-3));
    uint32_t frames = 0;
    while (const auto frame = camera.next()) {
        CHECK((*frame)->depth[0] == 0);
        CHECK((*frame)->depth[8] * camera.info().metresPerUnit == doctest::Approx(1.4 + 0.1 * frames));
        CHECK((*frame)->captureTime == doctest::Approx(5.0 + 0.1 * frames));
        ++frames;
    }
    CHECK(frames == 3);
}

std::string cloudRefusal(const std::filesystem::path& file, const SourceOptions& options = {}) {
    return testing::refusalOf([&] { openBag(file, options); });
}

// A cloud in ROS 1: 9 x 7 points of x, y, z at `distance` [m], `width` x `height` as stated.
std::string cloudMessage(double t, uint32_t width, uint32_t height, uint8_t type = 7, float distance = 1.0f,
                         const std::string& frame = "camera") {
    Out out;
    out.bytes = stampedHeader(t, frame);
    out.put(height).put(width).put(uint32_t{3});
    for (uint32_t i = 0; i < 3; ++i) {
        out.text(std::string(1, static_cast<char>('x' + i))).put(4 * i).put(type).put(uint32_t{1});
    }
    std::string points;
    for (uint32_t i = 0; i < 63; ++i) {
        const uint32_t column = i % 9, row = i / 9;
        const auto u = static_cast<float>(column), v = static_cast<float>(row);
        points += raw(distance * (u - 4.25f) / 10.0f) + raw(distance * (v - 3.5f) / 11.0f) + raw(distance);
    }
    out.put(uint8_t{0}).put(uint32_t{12}).put(12 * width).text(points).put(uint8_t{1});
    return out.bytes;
}

} // namespace

TEST_CASE("Organised clouds of ROS 2 are played as depth, in optical axes and in those of robots") {
    const auto optical = openBag(kClouds / "cloud"), robot = openBag(kClouds / "cloud_robot");
    CHECK(optical->info().hasColour);
    const auto frame = optical->next();
    REQUIRE(frame);
    CHECK((*frame)->colour[40] == 0xff1e14c8u);
    optical->seek(0);
    checkWalls(*optical);
    CHECK_FALSE(robot->info().hasColour);
    CHECK(robot->whyNoColour().find("rgb") != std::string::npos);
    checkWalls(*robot);
    CHECK(optical->streamOptions() == ",depth=/camera/depth/points");
    CHECK(openBag(kClouds / "cloud", {.scale = 0.001})->info().metresPerUnit == doctest::Approx(1e-4));
}

TEST_CASE("Clouds that are no depth images are rejected in one line with topic, reason and what is allowed") {
    const auto holds = [](const std::string& text, const std::string& part) {
        CAPTURE(text);
        CHECK(text.find(part) != std::string::npos);
    };
    holds(cloudRefusal(kClouds / "cloud_flat"),
          "/camera/depth/points: a cloud that is not organised: 63x1 points");
    holds(cloudRefusal(kClouds / "cloud_moved"), "points of frame 'camera_optical' deviate from the rays");
    holds(cloudRefusal(kClouds / "cloud_moved"), "points without a measurement are NaN or 0)");
    holds(cloudRefusal(kClouds / "cloud", {.intrinsics = "lens.json"}),
          "intrinsics: for clouds (allowed: neither");
    holds(cloudRefusal(kClouds / "cloud", {.colour = "/rgb"}), "colour: /rgb (allowed: colour=none");
    const TemporaryFolder folder;
    BagMaker maker;
    maker.add("/points", "sensor_msgs/PointCloud2", 1.0, cloudMessage(1.0, 9, 7, 6));
    maker.add("/long", "sensor_msgs/PointCloud2", 1.0, cloudMessage(1.0, 9, 7, 8)); // of 12 bytes
    folder.write("a.bag", maker.bag());
    holds(cloudRefusal(folder.path() / "a.bag"), "/points: field x: not floating point (allowed: x, y and z");
    holds(cloudRefusal(folder.path() / "a.bag", {.depth = "/long"}), "field z: beyond the bytes of a point");
}

TEST_CASE("A bag of ROS 1 plays its depth images before its clouds, unless a cloud is asked for") {
    const TemporaryFolder folder;
    BagMaker maker;
    for (const double t : {1.0, 1.1, 1.2}) {
        maker.add("/points", "sensor_msgs/PointCloud2", t, cloudMessage(t, 9, 7));
    }
    folder.write("clouds.bag", maker.bag());
    addStream(maker, "/depth/image", depthImage(500));
    folder.write("both.bag", maker.bag());
    CHECK(openBag(folder.path() / "both.bag")->info().depth.width == 8);
    CHECK(openBag(folder.path() / "both.bag", {.depth = "/points"})->info().depth.width == 9);
    CHECK(openBag(folder.path() / "clouds.bag")->info().depth.width == 9);
}

TEST_CASE("Of several clouds the camera's own is played, not one that a program took from it") {
    const TemporaryFolder folder;
    for (const auto& [other, own] :
         {std::pair<std::string, std::string>{"/camera/depth/obstacles", "/camera/depth/points"},
          {"/camera/depth/filtered_points", "/camera/depth/points"},
          {"/camera/depth/groundPlane", "/camera/depth/cloud"},
          {"/segmentation/points", "/camera/depth_registered/points"},
          {"/camera/cloud_data", "/camera/points"}}) {
        BagMaker maker;
        for (const double t : {1.0, 1.1, 1.2}) {
            maker.add(other, "sensor_msgs/PointCloud2", t, cloudMessage(t, 9, 7, 7, 2.0f));
            maker.add(own, "sensor_msgs/PointCloud2", t, cloudMessage(t, 9, 7));
        }
        folder.write("a.bag", maker.bag());
        CHECK(openBag(folder.path() / "a.bag")->streamOptions() == ",depth=" + own);
        CHECK(openBag(folder.path() / "a.bag", {.depth = other})->streamOptions() == ",depth=" + other);
    }
}

TEST_CASE("Clouds whose step of rows is wrong are played where their bytes are those of rows without gaps") {
    const TemporaryFolder folder;
    for (const uint32_t step : {0u, 9u, 9u * 7u * 12u, 63u}) {
        BagMaker maker;
        for (const double t : {1.0, 1.1, 1.2}) {
            std::string cloud = cloudMessage(t, 9, 7);
            const size_t at = cloud.size() - 63 * 12 - 4 - 4 - 1; // before the number of bytes
            cloud.replace(at, 4, raw(step));
            maker.add("/points", "sensor_msgs/PointCloud2", t, cloud);
        }
        folder.write("a.bag", maker.bag());
        const auto camera = openBag(folder.path() / "a.bag");
        uint32_t played = 0;
        for (; camera->next(); ++played) {
        }
        CHECK(played == 3);
        REQUIRE(camera->warnings().size() == 1);
        CHECK(camera->warnings()[0] ==
              "/points: rows of " + std::to_string(step) + " bytes are stated where they have 108");
    }
}

TEST_CASE("A big-endian cloud gives the same depth and colour") {
    const auto swapped = [](auto value) {
        std::string bytes = raw(value);
        std::reverse(bytes.begin(), bytes.end());
        return bytes;
    };
    Out out;
    out.bytes = stampedHeader(1.0, "camera");
    out.put(uint32_t{7}).put(uint32_t{9}).put(uint32_t{4});
    for (const char* field : {"x", "y", "z", "rgb"}) {
        out.text(field).put(*field == 'r' ? 12u : 4u * static_cast<uint32_t>(*field - 'x'));
        out.put(uint8_t{7}).put(uint32_t{1});
    }
    std::string points;
    for (uint32_t i = 0; i < 63; ++i) {
        const uint32_t column = i % 9, row = i / 9;
        const auto u = static_cast<float>(column), v = static_cast<float>(row);
        points +=
            swapped((u - 4.25f) / 10.0f) + swapped((v - 3.5f) / 11.0f) + swapped(1.0f) + swapped(0x00c8140au);
    }
    out.put(uint8_t{1}).put(uint32_t{16}).put(uint32_t{144}).text(points).put(uint8_t{1});
    BagMaker maker;
    maker.add("/points", "sensor_msgs/PointCloud2", 1.0, out.bytes);
    const TemporaryFolder folder;
    folder.write("a.bag", maker.bag());
    const auto camera = openBag(folder.path() / "a.bag");
    CHECK(camera->info().depth.fx == doctest::Approx(10.0).epsilon(1e-3));
    const auto frame = camera->next();
    REQUIRE(frame);
    CHECK((*frame)->depth[30] * camera->info().metresPerUnit == doctest::Approx(1.0));
    CHECK((*frame)->colour[30] == 0xff0a14c8u);
}

TEST_CASE("A cloud that is damaged, cut off, moved or of another frame is skipped and counted, and the "
          "others are played") {
    const TemporaryFolder folder;
    BagMaker maker;
    std::string cut = cloudMessage(1.1, 9, 7);
    cut.resize(cut.size() - 400);
    maker.add("/points", "sensor_msgs/PointCloud2", 1.0, cloudMessage(1.0, 9, 7));
    maker.add("/points", "sensor_msgs/PointCloud2", 1.1, cut);
    maker.add("/points", "sensor_msgs/PointCloud2", 1.2,
              cloudMessage(1.2, 9, 8)); // states more than it holds
    maker.add("/points", "sensor_msgs/PointCloud2", 1.3, cloudMessage(1.3, 9, 7));
    maker.add("/points", "sensor_msgs/PointCloud2", 1.4, cloudMessage(1.05, 9, 7)); // goes back
    maker.add("/points", "sensor_msgs/PointCloud2", 1.5, cloudMessage(1.5, 9, 7, 7, 1.0f, "other"));
    folder.write("a.bag", maker.bag());
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    const auto camera = openBag(folder.path() / "a.bag");
    uint32_t played = 0;
    while (camera->next()) {
        ++played;
    }
    spdlog::set_level(level);
    CHECK(played == 2);
    CHECK(camera->skipped() == 4);
}

TEST_CASE(
    "Points that the unit of depth cannot hold, because no sampled cloud is as far, are reported once") {
    const TemporaryFolder folder;
    BagMaker maker;
    for (int i = 0; i < 18; ++i) { // every second one is sampled for lens and unit
        const double t = 1.0 + 0.1 * i;
        maker.add("/points", "sensor_msgs/PointCloud2", t,
                  cloudMessage(t, 9, 7, 7, i % 2 == 0 ? 1.0f : 20.0f));
    }
    folder.write("a.bag", maker.bag());
    const auto camera = openBag(folder.path() / "a.bag");
    const testing::Listening log;
    uint32_t played = 0, measured = 0;
    while (const auto frame = camera->next()) {
        ++played;
        measured += (*frame)->depth[31] != 0 ? 1 : 0;
    }
    CHECK(played == 18);
    CHECK(measured == 9);
    CHECK(log.count("63 pixels are farther than") == 1);
}
