// SPDX-License-Identifier: Apache-2.0
// Frames, leases and bad frames of small recordings made here.
#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/replace_in.h"

#include <doctest/doctest.h>
#include <set>
#include <spdlog/spdlog.h>
#include <thread>

using namespace fathom;

namespace {

// Index and depth value of every delivered frame.
std::vector<std::pair<uint32_t, uint16_t>> play(RecordedCamera& camera) {
    std::vector<std::pair<uint32_t, uint16_t>> frames;
    while (const std::optional<Frame> frame = camera.next()) {
        frames.emplace_back((*frame)->index, (*frame)->depth[0]);
        CHECK((*frame)->sourceNumber == (*frame)->index);
    }
    return frames;
}

using Frames = std::vector<std::pair<uint32_t, uint16_t>>;

// A recording of four frames, frame 1 damaged in that way: three are delivered and one is skipped.
template <class Damage>
void checkSkipsFrameOne(const char* what, Damage&& damage) {
    CAPTURE(what);
    const TemporaryFolder folder;
    writeSmallRecording(folder, 4);
    damage(folder);
    RecordedCamera camera(folder.path());
    CHECK(play(camera) == Frames{{0, 1000}, {2, 1002}, {3, 1003}});
    CHECK(camera.skipped() == 1);
    CHECK_FALSE(camera.next().has_value());
}

void truncate(const std::filesystem::path& file, uintmax_t left) {
    std::filesystem::resize_file(file, std::min(left, std::filesystem::file_size(file)));
}

} // namespace

TEST_CASE("Comments and blank lines of the index are skipped, and the depth stamp is the capture time") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 3);
    testing::replaceIn(folder / "associations.txt", "0.100000 rgb/1.png 0.100000",
                       "# note\n\n0.111 rgb/1.png 0.125");
    RecordedCamera camera(folder.path());
    camera.next();
    const std::optional<Frame> frame = camera.next();
    REQUIRE(frame.has_value());
    CHECK((*frame)->index == 1);
    CHECK((*frame)->captureTime == 0.125);
    CHECK((*frame)->depth[34] == 1001);
    CHECK((*frame)->depth.size() == 35);
    CHECK((*frame)->colour[34] == 0xff1e1401); // R 1, G 20, B 30
}

TEST_CASE("A byte order mark in front of index or poses is skipped") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    const std::string mark = "\xEF\xBB\xBF";
    folder.write("associations.txt", mark + "0.0 rgb/0.png 0.0 depth/0.png\n0.1 rgb/1.png 0.1 depth/1.png\n");
    folder.write("poses.txt", mark + "0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{1000, 1001});
    folder.write("associations.txt", mark + "# comment\n0.1 rgb/1.png 0.1 depth/1.png\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{1001});
}

TEST_CASE("A missing, truncated or unreadable image skips only its frame") {
    for (const char* kind : {"rgb", "depth"}) {
        const std::string name = std::string(kind) + "/1.png";
        checkSkipsFrameOne("missing", [&](const auto& f) { std::filesystem::remove(f.path() / name); });
        checkSkipsFrameOne("empty", [&](const auto& f) { truncate(f.path() / name, 0); });
        checkSkipsFrameOne("header only", [&](const auto& f) { truncate(f.path() / name, 40); });
        for (uintmax_t gone : {12u, 14u}) { // the end mark alone; the end mark and half a checksum
            checkSkipsFrameOne("tail gone", [&](const auto& f) {
                truncate(f.path() / name, std::filesystem::file_size(f.path() / name) - gone);
            });
        }
        checkSkipsFrameOne("text", [&](const auto& f) { f.write(name, "this is no frame"); });
        checkSkipsFrameOne("a folder", [&](const auto& f) {
            std::filesystem::remove(f.path() / name);
            std::filesystem::create_directories(f.path() / name);
        });
    }
}

TEST_CASE("An image of another size or pixel type skips only its frame") {
    const std::vector<uint8_t> grey8(35, 7), rgb16(35 * 6, 7);
    checkSkipsFrameOne("depth wider", [](const auto& f) { writeDepth(f.path() / "depth/1.png", 8, 5, 9); });
    checkSkipsFrameOne("depth huge", [](const auto& f) { writeDepth(f.path() / "depth/1.png", 1, 5000, 9); });
    checkSkipsFrameOne("colour lower",
                       [](const auto& f) { writeColour(f.path() / "rgb/1.png", 7, 4, 1, 2, 3); });
    checkSkipsFrameOne("8-bit depth",
                       [&](const auto& f) { writePng(f.path() / "depth/1.png", 7, 5, 8, 0, grey8); });
    checkSkipsFrameOne("RGB depth",
                       [&](const auto& f) { writePng(f.path() / "depth/1.png", 7, 5, 16, 2, rgb16); });
}

TEST_CASE("A malformed line, an invalid stamp or one that goes back skips only its frame") {
    const std::string line = "0.100000 rgb/1.png 0.100000 depth/1.png";
    const auto replaced = [&](const std::string& by) {
        return [&line, by](const auto& f) { testing::replaceIn(f / "associations.txt", line, by); };
    };
    checkSkipsFrameOne("depth stamp back", replaced("0.1 rgb/1.png -0.5 depth/1.png"));
    checkSkipsFrameOne("depth stamp nan", replaced("0.1 rgb/1.png nan depth/1.png"));
    checkSkipsFrameOne("colour stamp inf", replaced("inf rgb/1.png 0.1 depth/1.png"));
    checkSkipsFrameOne("stamp text", replaced("0.1 rgb/1.png soon depth/1.png"));
    checkSkipsFrameOne("three words", replaced("0.1 rgb/1.png 0.1"));
    checkSkipsFrameOne("five words", replaced(line + " more"));
}

TEST_CASE("Images without any depth are valid frames") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    writeDepth(folder.path() / "depth/0.png", 7, 5, 0);
    RecordedCamera camera(folder.path());
    CHECK(play(camera) == Frames{{0, 0}, {1, 1001}});
    CHECK(camera.skipped() == 0);
}

TEST_CASE("colour is read from grey, palette, alpha and interlaced frames") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 5);
    const auto file = [&](int i) { return folder.path() / ("rgb/" + std::to_string(i) + ".png"); };
    std::vector<uint8_t> rgba;
    for (uint8_t i = 0; i < 35; ++i) {
        rgba.insert(rgba.end(), {i, 50, 60, 128});
    }
    writePng(file(0), 7, 5, 8, 0, std::vector<uint8_t>(35, 77));
    writePng(file(1), 7, 5, 8, 3, std::vector<uint8_t>(35, 2));
    writePng(file(2), 7, 5, 8, 6, rgba);
    writePng(file(3), 7, 5, 1, 0, std::vector<uint8_t>(5, 0x40)); // one bit: pixel 1 of each row is white
    writePng(file(4), 7, 5, 8, 6, rgba, true);
    RecordedCamera camera(folder.path());
    std::vector<Frame> frames;
    for (int i = 0; i < 5; ++i) {
        frames.push_back(camera.next().value());
    }
    CHECK(frames[0]->colour[9] == 0xff4d4d4d);
    CHECK(frames[1]->colour[34] == 0xffff0000); // blue
    CHECK(frames[2]->colour[33] == 0x803c3221);
    CHECK(frames[3]->colour[8] == 0xffffffff);
    CHECK(frames[3]->colour[9] == 0xff000000);
    CHECK(frames[4]->colour[33] == 0x803c3221);
    CHECK(camera.skipped() == 0);
}

TEST_CASE("Colour of 16 bits per channel becomes the nearest level of 8 bits") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    std::vector<uint8_t> rgb16;
    for (uint8_t i = 0; i < 35; ++i) { // 0xc800 is nearer to 0xc7 * 257 than to 0xc8 * 257
        rgb16.insert(rgb16.end(), {i, i, 0xc8, 0xc8, 0xc8, 0});
    }
    writePng(folder / "rgb/0.png", 7, 5, 16, 2, rgb16);
    writePng(folder / "rgb/1.png", 7, 5, 16, 0, std::vector<uint8_t>(70, 77));
    RecordedCamera camera(folder.path());
    CHECK((*camera.next())->colour[33] == 0xffc7c821);
    CHECK((*camera.next())->colour[9] == 0xff4d4d4d);
}

TEST_CASE("A lease owns its page-aligned memory until it ends, on any thread") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 40);
    RecordedCamera camera(folder.path());
    std::vector<Frame> held;
    std::set<const void*> places;
    for (uint32_t i = 0; i < Camera::kFramesInFlight; ++i) {
        held.push_back(camera.next().value());
        places.insert(held.back()->depth.data());
        CHECK(reinterpret_cast<uintptr_t>(held.back()->depth.data()) % 4096 == 0);
        CHECK(reinterpret_cast<uintptr_t>(held.back()->colour.data()) % 4096 == 0);
    }
    CHECK(places.size() == Camera::kFramesInFlight);
    for (uint32_t i = 4; i < 30; ++i) {
        Frame frame = camera.next().value();
        CHECK(frame->depth[0] == 1000 + i);
        CHECK(places.count(frame->depth.data()) == 0);
        std::thread([lease = std::move(frame)] {}).join();
    }
    for (uint32_t i = 0; i < held.size(); ++i) {
        CHECK(held[i]->depth[34] == 1000 + i);
    }
    held.push_back(camera.next().value());
    held.push_back(camera.next().value());
    CHECK_THROWS_AS(camera.next(), Error); // two more than are allowed at once
    held.clear();
    CHECK(camera.next().value()->index == 32);
}

TEST_CASE("poses are interpolated at the capture time and held for 50 ms outside their span") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 4); // stamps 0, 0.1, 0.2, 0.3
    folder.write("poses.txt",
                 "# t tx ty tz qx qy qz qw\n0.05 0 0 0 0 0 0 1\n0.15 2 0 0 0 0 1 0\n0.25 2 4 0 0 0 1 0\n");
    RecordedCamera camera(folder.path());
    const auto pose = [&] { return camera.next().value()->baseTcamera.value(); };
    CHECK(pose().position == dvec3(0, 0, 0));
    const Pose half = pose();
    CHECK(half.position.x == doctest::Approx(1.0));
    CHECK(glm::length(rotationLog(half.rotation)) == doctest::Approx(1.5707963267948966));
    CHECK(pose().position.y == doctest::Approx(2.0));
    CHECK(pose().position == dvec3(2, 4, 0));
}

TEST_CASE("without associations the nearest stamps within 20 ms make the pairs, each frame once") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 4);
    std::filesystem::remove(folder.path() / "associations.txt");
    folder.write("depth.txt",
                 "# depth\n0.000 depth/0.png\n0.033 depth/1.png\n0.075 depth/2.png\n0.200 depth/3.png\n");
    // Colour is half a period late: 0 goes to depth 0 (16.4 ms), 1 to depth 1 (17 ms) though depth 1 is
    // nearer to 0.
    folder.write("rgb.txt", "0.0164 rgb/0.png\n0.050 rgb/1.png\nbroken\n0.179 rgb/2.png\n0.190 rgb/3.png\n");
    RecordedCamera camera(folder.path());
    const Frame first = camera.next().value(), second = camera.next().value(), third = camera.next().value();
    CHECK_FALSE(camera.next().has_value());
    CHECK(first->depth[0] == 1000);
    CHECK((first->colour[0] & 255) == 0);
    CHECK(second->depth[0] == 1001);
    CHECK((second->colour[0] & 255) == 1);
    CHECK(third->index == 2);
    CHECK(third->depth[0] == 1003);
    CHECK((third->colour[0] & 255) == 3);
    CHECK(camera.skipped() == 0);
}

TEST_CASE("No line of an index can leave the recording's folder") {
    const TemporaryFolder folder;
    const char* lines[] = {"0 rgb/0.png 0 depth/0.png", "0 ../rgb/0.png 0 depth/0.png",
                           "0 rgb/0.png 0 /etc/hostname", "0 rgb/a/../../../x.png 0 depth/0.png",
                           "0 rgb/a/../b.png 0 ./depth/0.png"};
    std::string text;
    for (const char* line : lines) {
        text += std::string(line) + "\n";
    }
    folder.write("associations.txt", text);
    const std::vector<IndexLine> index = readIndex(folder.path(), {});
    REQUIRE(index.size() == 5);
    for (size_t i = 0; i < 5; ++i) {
        CAPTURE(lines[i]);
        const bool leads = index[i].fault.find("points outside the recording's folder") != std::string::npos;
        CHECK(leads == (i >= 1 && i <= 3));
        CHECK(index[i].depth.empty() == leads);
    }
    std::filesystem::remove(folder.path() / "associations.txt"); // the other kind of index leaves them out
    folder.write("depth.txt", "0 depth/0.png\n0.1 ../1.png\n0.2 depth/2.png\n");
    folder.write("rgb.txt", "0 rgb/0.png\n0.1 rgb/1.png\n0.2 /rgb/2.png\n");
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    CHECK(readIndex(folder.path(), {}).size() == 1);
    spdlog::set_level(level);
}

TEST_CASE("A recording can seek to any frame, and an invalid frame is counted once") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 5);
    std::filesystem::remove(folder.path() / "depth/1.png");
    RecordedCamera camera(folder.path());
    CHECK(camera.frameCount() == 5);
    const auto next = [&] {
        const std::optional<Frame> frame = camera.next();
        return frame ? static_cast<int>((*frame)->depth[0]) : 0;
    };
    REQUIRE(camera.seek(3));
    CHECK(next() == 1003);
    CHECK(next() == 1004);
    CHECK(next() == 0);
    for (int round = 0; round < 3; ++round) {
        REQUIRE(camera.seek(1)); // back in time; the next good one
        CHECK(next() == 1002);
        CHECK(camera.skipped() == 1);
    }
    REQUIRE(camera.seek(0));
    CHECK(next() == 1000);
    CHECK_FALSE(camera.seek(5));
}
