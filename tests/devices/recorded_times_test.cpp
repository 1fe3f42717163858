// SPDX-License-Identifier: Apache-2.0
// Times of a recording that do not belong together: poses and colour far from depth.
#include "devices/recorded/recorded_camera.h"
#include "engine/types/colour_copy.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"

#include <array>
#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("A frame without a pose in poses.txt is skipped and named: before it, after it, in a gap, or in "
          "another epoch") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 6); // stamps 0, 0.1, ... 0.5
    const auto indices = [&](const std::string& poses) {
        folder.write("poses.txt", poses);
        RecordedCamera camera(folder.path());
        std::vector<uint32_t> all;
        while (const std::optional<Frame> frame = camera.next()) {
            all.push_back((*frame)->index);
        }
        CHECK(camera.skipped() == 6 - all.size());
        CHECK(camera.warnings().size() == camera.skipped());
        return all;
    };
    const std::string end = " 0 0 0 0 0 0 1\n";
    using Indices = std::vector<uint32_t>;
    CHECK(indices("0" + end + "0.5" + end) == Indices{0, 1, 2, 3, 4, 5});
    CHECK(indices("0.26" + end + "1" + end) == Indices{3, 4, 5});
    CHECK(indices("-0.8" + end + "0.14" + end) == Indices{0, 1});
    CHECK(indices("0.1" + end + "1000" + end) == Indices{1}); // a gap
    CHECK(indices("-600" + end + "-599.9" + end + "0.2" + end + "0.6" + end) == Indices{2, 3, 4, 5});
    for (const char* poses : {"100 0 0 0 0 0 0 1\n200 0 0 0 0 0 0 1\n", "1700000000 0 0 0 0 0 0 1\n"}) {
        folder.write("poses.txt", poses);
        CHECK(recordingRefusal(folder.path()).find("before the first pose of poses.txt") !=
              std::string::npos);
    }
    folder.write("poses.txt", "0 1e7 0 0 0 0 0 1\n");
    CHECK(recordingRefusal(folder.path()).find("within 1000 km") != std::string::npos);
}

TEST_CASE("A single frame whose stamp goes back is skipped and named") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 5);
    std::string lines;
    const std::array<const char*, 5> stamps{"0.0", "0.1", "0.05", "0.2", "0.3"};
    for (size_t i = 0; i < stamps.size(); ++i) {
        const std::string image = std::to_string(i) + ".png\n", stamp = stamps[i];
        lines += stamp + " rgb/" + image.substr(0, image.size() - 1) + " " + stamp + " depth/" + image;
    }
    folder.write("associations.txt", lines);
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{1000, 1001, 1003, 1004});
    RecordedCamera camera(folder.path());
    while (camera.next()) {
    }
    REQUIRE(camera.warnings().size() == 1);
    CHECK(camera.warnings()[0].find("frame 2 skipped: depth stamp 0.050000 goes back from 0.100000") == 0);
}

TEST_CASE("A pair whose colour is over 0.1 s from its depth is skipped and named") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 4);
    folder.write("associations.txt", "0.00 rgb/0.png 0.0 depth/0.png\n5.1 rgb/1.png 0.1 depth/1.png\n"
                                     "0.25 rgb/2.png 0.2 depth/2.png\n-0.2 rgb/3.png 0.3 depth/3.png\n");
    RecordedCamera camera(folder.path());
    CHECK(camera.next().value()->index == 0);
    CHECK(camera.next().value()->index == 2);
    CHECK_FALSE(camera.next().has_value());
    REQUIRE(camera.warnings().size() == 2);
    CHECK(camera.warnings()[0].find("frame 1 skipped: its colour is 5.000000 s from its depth") == 0);
}

TEST_CASE("A heading without #, and a pause, change neither start nor what colour is too far in time") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 5);
    std::string late, good;
    for (int i = 0; i < 5; ++i) {
        const std::string n = std::to_string(i) + ".png", pause = i < 3 ? "130503110" : "130503810",
                          second = std::to_string(i);
        late += "1305031199 rgb/" + n + " " + pause + second + " depth/" + n + "\n";
        good += pause + second + " rgb/" + n + " " + pause + second + " depth/" + n + "\n";
    }
    for (const char* heading : {"", "rgb_time rgb depth_time depth\n", "rgb depth\n"}) {
        folder.write("associations.txt", heading + late);
        CHECK(recordingRefusal(folder.path()).find("is usable; first: ") != std::string::npos);
        folder.write("associations.txt", heading + good);
        using Played = std::vector<uint16_t>;
        CHECK(playedDepths(folder.path()) == Played{1000, 1001, 1002, 1003, 1004});
        CHECK(playedDepths(folder.path(), {.start = 1.0, .duration = 2.0}) == Played{1001, 1002});
        CHECK(playedDepths(folder.path(), {.start = 2.0}) == Played{1002, 1003, 1004});
    }
}

TEST_CASE("A start behind the last frame and a duration without a frame are named apart") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 3); // stamps 0, 0.1, 0.2
    const auto refused = [&](double start, double duration) {
        return recordingRefusal(folder.path(), {.start = start, .duration = duration});
    };
    CHECK(refused(0.04, 0.001).find("duration: 0.001") != std::string::npos);
    CHECK(refused(0.0, 0.0).find("duration: 0.0") != std::string::npos);
    CHECK(refused(0.3, 0.001).find("start: 0.3") != std::string::npos);
    CHECK(refused(0.3, 1.0).find("start: 0.3") != std::string::npos);
}

TEST_CASE("Stamps that are no seconds, and so pair nothing, are named with their distance") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    std::filesystem::remove(folder.path() / "associations.txt");
    folder.write("depth.txt", "1000 depth/0.png\n1033 depth/1.png\n"); // milliseconds
    folder.write("rgb.txt", "1038 rgb/1.png\n1006 rgb/0.png\n");
    CHECK(recordingRefusal(folder.path())
              .find("rgb.txt and depth.txt: no pair of images: depth and colour are at "
                    "least 5 apart, more than 0.02 (stamps are seconds)") != std::string::npos);
    folder.write("depth.txt", "1000000000 depth/0.png\n");
    folder.write("rgb.txt", "990000000 rgb/0.png\n");
    CHECK(recordingRefusal(folder.path()).find("at least 1e+07 apart") != std::string::npos);
}

TEST_CASE("After a clock is set back, a folder plays on with times that rise, unless poses need its stamps") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 12);
    std::string index;
    for (int i = 0; i < 12; ++i) {
        const std::string n = std::to_string(i) + ".png", stamp = std::to_string(0.1 * (i < 7 ? 100 + i : i));
        index += stamp + " rgb/" + n + " " + stamp + " depth/" + n + "\n";
    }
    folder.write("associations.txt", index);
    RecordedCamera camera(folder.path());
    REQUIRE(camera.warnings().size() == 1);
    CHECK(camera.warnings()[0].find("the clock of depth goes back by 9.900000 s at frame 7: times") == 0);
    for (uint32_t i = 0; i < 12; ++i) {
        const std::optional<Frame> frame = camera.next();
        REQUIRE(frame.has_value());
        CHECK((*frame)->index == i);
        CHECK((*frame)->captureTime == doctest::Approx(10.0 + 0.1 * i));
    }
    CHECK(camera.skipped() == 0);
    folder.write("poses.txt", "10 0 0 0 0 0 0 1\n10.7 0 0 0 0 0 0 1\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{1000, 1001, 1002, 1003, 1004, 1005, 1006});
}

TEST_CASE("Where half of the stamps do not rise, all frames are played at 30 per second, unless poses need "
          "stamps") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 4);
    for (const char* second : {"5", "4.9"}) { // equal, and back
        std::string index;
        for (int i = 0; i < 4; ++i) {
            const std::string n = std::to_string(i) + ".png", stamp = i % 2 == 0 ? "5" : second;
            index += stamp + " rgb/" + n + " " + stamp + " depth/" + n + "\n";
        }
        folder.write("associations.txt", index);
        RecordedCamera camera(folder.path());
        for (uint32_t i = 0; i < 4; ++i) {
            const std::optional<Frame> frame = camera.next();
            REQUIRE(frame.has_value());
            CHECK((*frame)->captureTime == doctest::Approx(i / 30.0));
        }
        CHECK(camera.skipped() == 0);
        folder.write("poses.txt", "5 0 0 0 0 0 0 1\n");
        CHECK(recordingRefusal(folder.path()).find("of 4 depth stamps do not rise (allowed: rising stamps") !=
              std::string::npos);
        std::filesystem::remove(folder.path() / "poses.txt");
    }
}

TEST_CASE("Stamps of another unit than seconds have a warning where depth and colour have the same ones") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 3);
    const auto warnings = [&](double unit) {
        std::string index;
        for (int i = 0; i < 3; ++i) {
            const std::string n = std::to_string(i) + ".png", stamp = std::to_string(i * 0.033 * unit);
            index += stamp + " rgb/" + n + " " + stamp + " depth/" + n + "\n";
        }
        folder.write("associations.txt", index);
        const testing::Listening log;
        CHECK(playedDepths(folder.path()).size() == 3);
        const size_t named = RecordedCamera(folder.path()).warnings().size();
        CHECK(named * 2 == log.count("s between its frames: stamps are read as seconds"));
        return named;
    };
    CHECK(warnings(1.0) == 0);
    CHECK(warnings(1e3) == 1);
    CHECK(warnings(1e9) == 1);
    folder.write("associations.txt", "1.7e18 rgb/0.png 1.7e18 depth/0.png\n");
    CHECK(recordingRefusal(folder.path(), {.duration = 0.1}).find("duration: 0.1") != std::string::npos);
}

TEST_CASE("Stamps that count frames have a warning, whole seconds since 1970 and few frames have none") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 12);
    const auto warned = [&](double first, double step, int frames) {
        std::string index;
        for (int i = 0; i < frames; ++i) {
            const std::string n = std::to_string(i) + ".png", stamp = std::to_string(first + step * i);
            index += stamp + " rgb/" + n + " " + stamp + " depth/" + n + "\n";
        }
        folder.write("associations.txt", index);
        const std::vector<std::string> lines = RecordedCamera(folder.path()).warnings();
        return lines.size() == 1 && lines[0].find("look like numbers of frames") != std::string::npos;
    };
    CHECK(warned(0.0, 1.0, 12));
    CHECK(warned(1.0, 1.0, 12));
    CHECK_FALSE(warned(0.5, 1.0, 12));
    CHECK_FALSE(warned(0.0, 1.0, 4));
    CHECK_FALSE(warned(0.0, 2.0, 12));
    CHECK_FALSE(warned(1305031100.0, 1.0, 12));
}

TEST_CASE(
    "Images of rgb.txt and depth.txt whose stamps are rounded to one time are paired in order, and those "
    "without a partner are named with their number") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 12);
    std::filesystem::remove(folder.path() / "associations.txt");
    const auto play = [&](const auto& depthStamp, const auto& colourStamp) {
        std::string depth, colour;
        for (int i = 0; i < 12; ++i) {
            depth += depthStamp(i);
            depth += " depth/" + std::to_string(i) + ".png\n";
            colour += colourStamp(i);
            colour += " rgb/" + std::to_string(i) + ".png\n";
        }
        folder.write("depth.txt", depth);
        folder.write("rgb.txt", colour);
        return playedDepths(folder.path());
    };
    const auto rounded = [](int) { return std::string("1.30503110e+09"); };
    const auto exact = [](int i) { return std::to_string(100.0 + 0.1 * i); };
    const testing::Listening log;
    CHECK(play(rounded, rounded).size() == 12);
    RecordedCamera camera(folder.path());
    for (uint32_t i = 0; i < 12; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[0] == 1000 + i);
        CHECK((coloursOf(**frame)[0] & 0xff) == i);
    }
    CHECK(log.count("have no colour image") == 0);
    const auto late = [](int i) { return std::to_string(100.0 + 0.1 * i + (i > 3 && i < 7 ? 0.03 : 0.0)); };
    CHECK(play(exact, late).size() == 9);
    CHECK(log.count("3 of 12 depth images have no colour image within 0.02 s: they are not played") == 1);
    const auto later = [](int i) { return std::to_string(100.3 + 0.1 * i); };
    CHECK(play(exact, later).size() == 9); // colour begins after the first depth images
    CHECK(log.count("have no colour image") == 1);
}

TEST_CASE("An index and poses.txt beside a lens file of Open3D give stamps, pairs and poses") {
    for (const char* lens : {"camera_primesense.json", "intrinsic.json", "camera_intrinsic.json"}) {
        CAPTURE(lens);
        const TemporaryFolder folder;
        writeSmallRecording(folder, 3);
        std::filesystem::remove(folder.path() / "intrinsics.json");
        folder.write(lens, R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6, 0, 3, 2, 1]})");
        folder.write("associations.txt",
                     "100 rgb/0.png 100 depth/0.png\n100.25 rgb/2.png 100.25 depth/2.png\n");
        folder.write("poses.txt", "99 0 0 0 0 0 0 1\n100 0 0 0 0 0 0 1\n100.5 0.5 0 0 0 0 0 1\n");
        const testing::Listening log;
        RecordedCamera camera(folder.path());
        CHECK(log.count("poses.txt is not read") == 0);
        CHECK_FALSE(camera.info().poseless);
        CHECK(camera.info().metresPerUnit == 0.001);
        REQUIRE(camera.warnings().size() == 1);
        CHECK(camera.warnings()[0].find("states no depth scale") != std::string::npos);
        CHECK(RecordedCamera(folder.path(), {.scale = 0.0002}).warnings().empty());
        const auto first = camera.next(), second = camera.next();
        REQUIRE(first);
        REQUIRE(second);
        CHECK((*second)->depth[0] == 1002);
        CHECK((*second)->captureTime - (*first)->captureTime == doctest::Approx(0.25));
        REQUIRE((*second)->baseTcamera);
        CHECK((*second)->baseTcamera->position.x == doctest::Approx(0.25));
        std::filesystem::remove(folder.path() / "associations.txt"); // depth.txt alone is no index
        folder.write("depth.txt", "100 depth/0.png\n");
        CHECK(playedDepths(folder.path()).size() == 3);
    }
}
