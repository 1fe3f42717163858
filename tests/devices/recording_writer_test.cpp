// SPDX-License-Identifier: Apache-2.0
// What the recording writer leaves is what the recorded camera reads, to the last bit.
#include "devices/recorded/recording_writer.h"

#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/eventually.h"

#include <algorithm>
#include <csignal>
#include <doctest/doctest.h>
#include <random>

#include <sys/wait.h>
#include <unistd.h>

using namespace fathom;

namespace {

constexpr uint32_t kWidth = 37, kHeight = 23;

CameraInfo someCamera(bool registered, bool colour = true) {
    CameraInfo info;
    info.depth = {.width = kWidth, .height = kHeight, .fx = 30.5, .fy = 30.25, .cx = 18.125, .cy = 11.0};
    info.colour = info.depth;
    info.metresPerUnit = 0.00025;
    info.registered = registered;
    info.hasColour = colour;
    if (!registered) {
        info.colour.width = 40;
        info.colour.height = 20;
        info.colour.distortion = {0.01, -0.02, 0.001, -0.001, 0.003};
        info.colourTdepth = {{0.015, -0.001, 0.002}, glm::normalize(dquat(1.0, 0.01, -0.02, 0.005))};
    }
    return info;
}

struct Image {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour;
    Frame frame(uint32_t i, bool pose) const {
        Frame::Content content;
        content.index = i;
        content.sourceNumber = i + 1;
        content.captureTime = 86400.125 + i / 30.0;
        content.depth = depth;
        content.colour = colour;
        if (pose) {
            content.baseTcamera = Pose{{0.1 * i, 0.2, 0.3}, dquat(1, 0, 0, 0)};
        }
        return Frame(content, nullptr);
    }
};

std::vector<Image> someImages(const CameraInfo& info, uint32_t count) {
    std::mt19937 random(11);
    std::vector<Image> images(count);
    for (Image& p : images) {
        p.depth.resize(info.depth.pixels());
        p.colour.resize(info.hasColour ? info.colour.pixels() : 0);
        for (uint16_t& d : p.depth) {
            d = static_cast<uint16_t>(random());
        }
        for (uint32_t& c : p.colour) {
            c = static_cast<uint32_t>(random()) | 0xff000000u;
        }
    }
    return images;
}

void roundTrip(const CameraInfo& info, uint32_t count, bool poses) {
    const TemporaryFolder folder;
    const std::vector<Image> images = someImages(info, count);
    {
        RecordingWriter writer(folder.path() / "rec", info, 2);
        for (uint32_t i = 0; i < count; ++i) {
            writer.add(images[i].frame(i, poses));
        }
        writer.finish();
        CHECK(writer.frames() == count);
    }
    RecordedCamera camera(folder.path() / "rec");
    const CameraInfo& read = camera.info();
    CHECK(read.hasColour == info.hasColour);
    CHECK(read.registered == info.registered);
    CHECK(read.metresPerUnit == info.metresPerUnit);
    CHECK(read.depth.fx == info.depth.fx);
    CHECK(read.depth.cy == info.depth.cy);
    if (!info.registered) {
        CHECK(read.colour.width == info.colour.width);
        CHECK(read.colour.distortion == info.colour.distortion);
        CHECK(glm::length(read.colourTdepth.position - info.colourTdepth.position) < 1e-15);
    }
    for (uint32_t i = 0; i < count; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->captureTime == doctest::Approx(86400.125 + i / 30.0).epsilon(1e-14));
        CHECK(std::equal((*frame)->depth.begin(), (*frame)->depth.end(), images[i].depth.begin()));
        CHECK((*frame)->colour.size() == images[i].colour.size());
        CHECK(std::equal((*frame)->colour.begin(), (*frame)->colour.end(), images[i].colour.begin()));
        CHECK((*frame)->baseTcamera.has_value() == poses);
        if (poses) {
            CHECK((*frame)->baseTcamera->position.x == doctest::Approx(0.1 * i).epsilon(1e-9));
        }
    }
    CHECK_FALSE(camera.next());
    CHECK(camera.skipped() == 0);
}

} // namespace

TEST_CASE("A written recording is read back bit by bit: registered, with two lenses, with poses") {
    roundTrip(someCamera(true), 25, false);
    roundTrip(someCamera(false), 7, true);
    roundTrip(someCamera(true), 1, true);
}

TEST_CASE("A recording with depth only is written and read") {
    roundTrip(someCamera(true, false), 9, false);
}

TEST_CASE("A folder with a recording is not overwritten, and an unwritable one is an error") {
    const TemporaryFolder folder;
    const CameraInfo info = someCamera(true);
    const Image image = someImages(info, 1)[0];
    RecordingWriter(folder.path() / "rec", info, 1).add({1.0, image.depth, image.colour, {}});
    CHECK_THROWS_AS(RecordingWriter(folder.path() / "rec", someCamera(true), 1), BadInput);
    CHECK_THROWS_AS(RecordingWriter("/proc/rec", someCamera(true), 1), Error);
}

TEST_CASE("A writer without frames removes its files and image folders, so that the folder can be used") {
    const TemporaryFolder folder;
    folder.write("notes.txt", "mine");
    for (const bool colour : {true, false}) {
        for (const bool finished : {true, false}) {
            RecordingWriter writer(folder.path(), someCamera(true, colour), 1);
            CHECK(std::filesystem::exists(folder.path() / "intrinsics.json"));
            if (finished) {
                writer.finish();
            }
        }
        CHECK(folder.read("notes.txt") == "mine");
        CHECK(std::ranges::distance(std::filesystem::directory_iterator(folder.path())) == 1);
    }
}

TEST_CASE("A writer that cannot write its first files leaves none of them") {
    const TemporaryFolder folder;
    {
        const FileSizeLimit small(3); // the empty index, but no intrinsics
        CHECK_THROWS_AS(RecordingWriter(folder.path(), someCamera(true), 1), Error);
    }
    CHECK(folder.files() == 0);
    CHECK_NOTHROW(RecordingWriter(folder.path(), someCamera(true), 1));
}

TEST_CASE("A folder of another layout, and one whose depth or rgb folder holds files, is never written to") {
    const CameraInfo info = someCamera(true);
    for (const char* name :
         {"scene_camera.json", "camera_intrinsic.json", "frame-000000.depth.png",
          "intrinsic/intrinsic_depth.txt", "intrinsics_depth.txt", "cam_K.txt", "metadata.yaml", "poses.txt",
          "groundtruth.txt", "depth/000000.png", "rgb/any.jpg"}) {
        const TemporaryFolder folder;
        folder.write(name, "kept");
        CHECK_THROWS_WITH_AS(RecordingWriter(folder.path(), info, 1),
                             doctest::Contains("a folder without a recording"), BadInput);
        CHECK(folder.read(name) == "kept");
        CHECK_FALSE(std::filesystem::exists(folder.path() / "intrinsics.json"));
    }
}

TEST_CASE("A file or a link named depth or rgb is kept, and nothing is written next to it") {
    for (const char* name : {"depth", "rgb"}) {
        for (const bool link : {false, true}) {
            CAPTURE(name);
            const TemporaryFolder folder;
            folder.write(link ? "target" : name, "mine");
            if (link) {
                std::filesystem::create_symlink("target", folder.path() / name);
            }
            CHECK_THROWS_AS(RecordingWriter(folder.path(), someCamera(true), 1), BadInput);
            CHECK(folder.read(name) == "mine");
            CHECK(folder.files() == (link ? 2 : 1));
        }
    }
}

TEST_CASE("Frames of one stamp are written so that all are read again, with their pose") {
    const TemporaryFolder folder;
    const CameraInfo info = someCamera(true);
    const std::vector<Image> images = someImages(info, 3);
    {
        RecordingWriter writer(folder.path() / "rec", info, 2);
        const double stamps[] = {1.0, 1.0, 1.033};
        for (size_t i = 0; i < 3; ++i) {
            writer.add(
                {stamps[i], images[i].depth, images[i].colour, Pose{{stamps[i], 0, 0}, dquat(1, 0, 0, 0)}});
        }
        writer.finish();
    }
    RecordedCamera camera(folder.path() / "rec");
    for (size_t i = 0; i < 3; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK(std::equal((*frame)->depth.begin(), (*frame)->depth.end(), images[i].depth.begin()));
        REQUIRE((*frame)->baseTcamera);
        CHECK((*frame)->baseTcamera->position.x == (i < 2 ? 1.0 : 1.033));
    }
    CHECK(camera.skipped() == 0);
}

TEST_CASE("An image that appears while a recording is written is not overwritten") {
    const TemporaryFolder folder;
    const CameraInfo info = someCamera(true);
    RecordingWriter writer(folder.path(), info, 1);
    folder.write("rgb/000000.png", "kept");
    writer.add(someImages(info, 1)[0].frame(0, false));
    CHECK_THROWS_WITH(writer.finish(), doctest::Contains("rgb/000000.png: cannot be written (File exists)"));
    CHECK(folder.read("rgb/000000.png") == "kept");
}

TEST_CASE("An image that cannot be written stops the recording with the file's name; earlier frames stay") {
    const TemporaryFolder folder;
    const CameraInfo info = someCamera(true);
    const std::vector<Image> images = someImages(info, 3);
    RecordingWriter writer(folder.path() / "rec", info, 1);
    std::filesystem::create_directory(folder.path() / "rec/depth/000002.png"); // in the way
    for (uint32_t i = 0; i < 3; ++i) {
        writer.add(images[i].frame(i, false));
    }
    CHECK_THROWS_WITH(writer.finish(), doctest::Contains("000002.png"));
    RecordedCamera camera(folder.path() / "rec");
    CHECK(camera.next());
    CHECK(camera.next());
    CHECK_FALSE(camera.next());
}

TEST_CASE("A recorder killed by SIGKILL leaves a shorter recording with complete images") {
    const TemporaryFolder folder;
    const CameraInfo info = someCamera(true);
    const std::vector<Image> images = someImages(info, 40);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        RecordingWriter writer(folder.path() / "rec", info, 2);
        for (uint32_t i = 0;; ++i) {
            writer.add(images[i % 40].frame(i, true));
        }
    }
    const auto index = folder.path() / "rec/associations.txt";
    std::error_code ignored;
    CHECK(testing::eventually([&] { return std::filesystem::file_size(index, ignored) > 500 && !ignored; }));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    RecordedCamera camera(folder.path() / "rec");
    uint32_t frames = 0;
    while (const auto frame = camera.next()) {
        CHECK(std::equal((*frame)->depth.begin(), (*frame)->depth.end(), images[frames % 40].depth.begin()));
        CHECK((*frame)->baseTcamera.has_value());
        ++frames;
    }
    CHECK(frames >= 5);
    CHECK(camera.skipped() <= 1); // a line that was cut off is no frame
}

TEST_CASE("Frames of 640x480 that arrive faster than they are encoded are all written") {
    constexpr uint32_t kMany = 120; // more than may wait
    CameraInfo info = someCamera(true);
    info.depth.width = info.colour.width = 640;
    info.depth.height = info.colour.height = 480;
    Image image{std::vector<uint16_t>(info.depth.pixels()), std::vector<uint32_t>(info.depth.pixels())};
    std::mt19937 random(3);
    for (uint32_t i = 0; i < info.depth.pixels(); ++i) { // a slope, with a camera's noise
        image.depth[i] = static_cast<uint16_t>(900 + i % 640 / 4 + random() % 5);
        image.colour[i] = 0xff000000u | static_cast<uint32_t>(120 + i / 640 / 8 + random() % 8) * 0x010101u;
    }
    const TemporaryFolder folder;
    RecordingWriter writer(folder.path() / "rec", info, 2);
    for (uint32_t i = 0; i < kMany; ++i) {
        image.depth[0] = static_cast<uint16_t>(i);
        writer.add(image.frame(i, false));
    }
    writer.finish();
    RecordedCamera camera(folder.path() / "rec");
    uint32_t count = 0;
    while (const auto frame = camera.next()) {
        image.depth[0] = static_cast<uint16_t>(count++);
        CHECK(std::equal(image.depth.begin(), image.depth.end(), (*frame)->depth.begin()));
    }
    CHECK(count == kMany);
}
