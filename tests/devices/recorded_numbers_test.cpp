// SPDX-License-Identifier: Apache-2.0
// Folders without an index: images in order of the numbers in their names, and pairs by them.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

#include <bit>

using namespace fathom;
using namespace fathom::testing;

namespace {

using Depths = std::vector<uint16_t>;

// An Open3D folder of these names, with depth 500, 600, ... in their order.
void writeNamed(const TemporaryFolder& folder, const std::vector<std::string>& depth,
                const std::vector<std::string>& colour) {
    folder.write("camera_intrinsic.json",
                 R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6.5, 0, 3, 2, 1]})");
    for (size_t i = 0; i < depth.size(); ++i) {
        writeDepth(folder.path() / "depth" / (depth[i] + ".png"), kSmallWidth, kSmallHeight,
                   static_cast<uint16_t>(500 + 100 * i));
    }
    for (size_t i = 0; i < colour.size(); ++i) {
        writeColour(folder.path() / "color" / (colour[i] + ".png"), kSmallWidth, kSmallHeight,
                    static_cast<uint8_t>(10 * i), 0, 0);
    }
}

Depths depthsOfNames(const std::vector<std::string>& depth, const std::vector<std::string>& colour) {
    const TemporaryFolder folder;
    writeNamed(folder, depth, colour);
    return playedDepths(folder.path());
}

SourceOptions lensIn(const TemporaryFolder& folder) {
    folder.write("lens.json", kSmallIntrinsics);
    return {.intrinsics = folder.path() / "lens.json"};
}

// Plays pairs with these names; returns how often a line says that zeros may be lost.
size_t lostZeros(const std::vector<std::string>& names) {
    const TemporaryFolder folder;
    for (const std::string& name : names) {
        addPair(folder, "depth/" + name + ".png", "rgb/" + name + ".png", 500);
    }
    const testing::Listening log;
    recordingRefusal(folder.path(), lensIn(folder));
    return log.count("without leading zeros");
}

} // namespace

TEST_CASE("Names that are stamps in seconds or nanoseconds play in order of time, none lost") {
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"1305031102.900000", "1305031103.100000", "1305031103.500000",
                                   "1305031104.100000"},
          {"4294967295", "4294967296", "4294967297", "42949672960"},
          {"1403636579763555584", "1403636579796888917", "1403636579830222250", "14036365798302222500"},
          {"8", "9", "10", "11"},
          {"rgbd_08", "rgbd_009", "rgbd_10", "rgbd_0011"}}) {
        CHECK(depthsOfNames(names, names) == Depths{500, 600, 700, 800});
    }
}

TEST_CASE("File names pair by their counter; if a stamp follows the counter, by the stamp") {
    using Names = std::vector<std::string>;
    for (const auto& given :
         {std::pair(
              Names{"1305031102175_0001", "1305031102242_0002", "1305031102375_0004"},
              Names{"1305031102180_0001", "1305031102247_0002", "1305031102313_0003", "1305031102380_0004"}),
          std::pair(
              Names{"depth_640x480_0000", "depth_640x480_0001", "depth_640x480_0003"},
              Names{"rgb_1280x720_0000", "rgb_1280x720_0001", "rgb_1280x720_0002", "rgb_1280x720_0003"}),
          std::pair(Names{"0000002-000000000000", "0000003-000000033369", "0000004-000000100107"},
                    Names{"0000001-000000000000", "0000002-000000033369", "0000003-000000066738",
                          "0000004-000000100107"})}) {
        const auto &depth = given.first, &colour = given.second;
        INFO(depth.front());
        const TemporaryFolder folder;
        writeNamed(folder, depth, colour);
        RecordedCamera camera(folder.path());
        for (const uint32_t i : {0u, 1u, 3u}) {
            const auto frame = camera.next();
            REQUIRE(frame);
            CHECK(((*frame)->colour[0] & 0xff) == 10 * i);
        }
    }
}

TEST_CASE("Names of a frame and a time pair by the frame where the times of depth and colour differ") {
    const TemporaryFolder folder;
    writeNamed(folder, {"0000001-000000000000", "0000002-000000033369", "0000003-000000066738"},
               {"0000001-000000000000", "0000002-000000033380", "0000003-000000066749"});
    RecordedCamera camera(folder.path());
    for (uint32_t i = 0; i < 3; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[0] == 500 + 100 * i);
        CHECK(((*frame)->colour[0] & 0xff) == 10 * i);
    }
    CHECK(camera.skipped() == 0);
}

TEST_CASE("Equally many images without a common number pair in order; a single lost image is skipped") {
    CHECK(depthsOfNames({"1.16", "1.19", "1.23"}, {"1.17", "1.2", "1.24"}) == Depths{500, 600, 700});
    CHECK(depthsOfNames({"0", "1", "2"}, {"0", "1", "3"}) == Depths{500, 600});
    CHECK(depthsOfNames({"0", "1", "2"}, {"1"}) == Depths{600});
}

TEST_CASE("Two images of one number are rejected, whatever the order of the folder") {
    const TemporaryFolder folder;
    writeNamed(folder, {"00000", "left_0"}, {"00000"});
    CHECK(recordingRefusal(folder.path())
              .find("names of images: 00000.png and left_0.png with 0 (allowed: one image of each number)") !=
          std::string::npos);
}

TEST_CASE(
    "Names of a date or a time play in order of time, though the milliseconds at their end begin anew") {
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"20240101_120000_000", "20240101_120000_666", "20240101_120001_333",
                                   "20240101_120002_000"},
          {"12-00-00.333", "12-00-00.9", "12-00-01.333", "12-01-00.100"},
          {"2024-01-31_23-59-58", "2024-01-31_23-59-59", "2024-02-01_00-00-00", "2024-02-01_00-00-01"},
          {"1600000000_000000000", "1600000000_500000000", "1600000001_000000000", "1600000001_500000000"}}) {
        CAPTURE(names[0]);
        CHECK(depthsOfNames(names, names) == Depths{500, 600, 700, 800});
        const TemporaryFolder folder;
        writeNamed(folder, names, {});
        CHECK(playedDepths(folder.path(), {.colour = "none"}) == Depths{500, 600, 700, 800});
    }
    CHECK(depthsOfNames({"cam10_1", "cam9_2"}, {"1", "2"}) == Depths{500, 600}); // a counter orders alone
}

TEST_CASE("A counter behind a point, as in cam1.9 and cam1.10, orders and pairs images as any other") {
    using Names = std::vector<std::string>;
    const Names names{"cam1.8", "cam1.9", "cam1.10", "cam1.11"}, begun{"v2.0", "v2.1", "v2.2", "v2.10"};
    for (const Names& all : {names, begun}) {
        CHECK(depthsOfNames(all, all) == Depths{500, 600, 700, 800});
    }
    const Names few{"cam1.8", "cam1.9"}; // of one kind, and those of the other count beyond 9
    CHECK(depthsOfNames(names, few) == Depths{500, 600});
    CHECK(depthsOfNames(few, {"cam2.8", "cam2.9", "cam2.10"}) == Depths{500, 600});
    const Names seconds{"7.5", "7.52", "7.6", "7.64"}; // decimals without their last zeros
    CHECK(depthsOfNames(seconds, seconds) == Depths{500, 600, 700, 800});
}

TEST_CASE("Images of several cameras in one folder are refused, however long the numbers in front are") {
    using Names = std::vector<std::string>;
    for (const Names& names :
         {Names{"000000_0", "000000_1", "000001_0", "000001_1"},
          {"1305031102000_cam1", "1305031102000_cam2", "1305031102033_cam1", "1305031102033_cam2"},
          {"213522070137_000000", "213522070137_000001", "851112060943_000000",
           "851112060943_000001"}, // serial numbers
          {"a1b2c3d4e5f6_d0_0", "a1b2c3d4e5f6_d0_1", "a1b2c3d4e5f6_d1_0", "a1b2c3d4e5f6_d1_1"}}) {
        const TemporaryFolder folder;
        writeNamed(folder, names, names);
        CAPTURE(names[0]);
        for (const char* colour : {"", "none"}) {
            mentions(recordingRefusal(folder.path(), {.colour = colour}),
                     "names of images: " + names[0] + ".png and " + names[1] +
                         ".png, as of several cameras: the same 2 last numbers behind 2 others (allowed: the "
                         "images of one camera)");
        }
    }
    const Names clock{"20240101_12-00-00", "20240101_12-00-01", "20240101_12-01-00", "20240101_12-01-01"};
    CHECK(depthsOfNames(clock, clock) == Depths{500, 600, 700, 800});
}

TEST_CASE("A counter that begins anew each second, or in each episode of equal length, is one camera's") {
    for (const auto& series :
         {std::pair(std::vector<std::string>{"20240101_120058", "20240101_120059", "20240101_120100"}, 10),
          {{"20240101_120000", "20240101_120001", "20240101_120002"}, 3},
          {{"2024-01-01_12-00-00", "2024-01-01_12-00-01"}, 2},
          {{"240101120000", "240101120001", "240101120002"}, 2},
          {{"120000", "120001", "120002"}, 2},
          {{"1600000000", "1600000001"}, 2},
          {{"000000", "000001"}, 4},                   // episodes
          {{"20240101_120000", "20240101_130000"}, 4}, // recordings of one day
          {{"1600000000123", "1600000100456"}, 4}}) {
        CAPTURE(series.first[0]);
        std::vector<std::string> names;
        Depths depths;
        for (const std::string& front : series.first) {
            for (int i = 0; i < series.second; ++i) {
                depths.push_back(static_cast<uint16_t>(500 + 100 * names.size()));
                names.push_back(front + "_" + std::to_string(i));
            }
        }
        CHECK(depthsOfNames(names, names) == depths);
    }
    const std::vector<std::string> serials{"213522070137_0", "213522070137_1", "213522070137_2",
                                           "851112060943_0", "851112060943_1", "851112060943_2"};
    const TemporaryFolder folder;
    writeNamed(folder, serials, serials);
    mentions(recordingRefusal(folder.path()), "the same 3 last numbers behind 2 others");
}

TEST_CASE("A number in front of the image's kind counts where no name ends in a number") {
    CHECK(depthsOfNames({"0000_depth", "0001_depth"}, {"0000_color", "0001_color"}) == Depths{500, 600});
    CHECK(depthsOfNames({"frame0000.depth", "frame0001.depth"}, {"1", "0"}) == Depths{500, 600});
    CHECK(depthsOfNames({"0_640x480", "1_640x480"}, {"0_1280x720", "1_1280x720"}) == Depths{500, 600});
    const TemporaryFolder depthOnly;
    writeNamed(depthOnly, {"0000_depth16", "0001_depth16"}, {});
    CHECK(playedDepths(depthOnly.path(), {.colour = "none"}) == Depths{500, 600});
    CHECK(depthsOfNames({"0", "1", "0_view", "1_view"}, {"0", "1"}) == Depths{500, 600});
}

TEST_CASE("Images whose names do not end in a decimal number are counted in one warning") {
    const TemporaryFolder folder;
    writeNamed(folder, {"frame_8", "frame_9", "frame_a", "frame_b"}, {"frame_8", "frame_9"});
    const testing::Listening log;
    CHECK(playedDepths(folder.path()) == Depths{500, 600});
    CHECK(
        log.count("2 of 4 images are not played, because their names do not end in a decimal number; first: "
                  "frame_a.png") == 1);
}

TEST_CASE("Stamps of intrinsics.json belong to images in order of the numbers in their names") {
    const TemporaryFolder folder;
    std::string stamps;
    for (uint16_t i = 0; i < 12; ++i) {
        addPair(folder, "depth/" + std::to_string(i) + ".png", "rgb/" + std::to_string(i) + ".png", 500 + i);
        stamps += (i == 0 ? "" : ", ") + std::to_string(i);
    }
    std::string lens = kSmallIntrinsics;
    folder.write("intrinsics.json",
                 lens.insert(lens.find('{') + 1, R"("depth_stamps_s": [)" + stamps +
                                                     R"(], "color_stamps_s": [)" + stamps + "], "));
    CHECK(playedDepths(folder.path()) == Depths{500, 501, 502, 503, 504, 505, 506, 507, 508, 509, 510, 511});
}

TEST_CASE("Millimetres rotated by three bits are read as SUN3D wrote them, not where a scale is given") {
    const auto folderOf = [](const TemporaryFolder& folder, const std::string& name, uint16_t farthest,
                             uint16_t step, int rotation) {
        folder.write("intrinsics.json", kSmallIntrinsics);
        std::vector<uint8_t> bytes;
        for (uint16_t i = 0; i < kSmallWidth * kSmallHeight; ++i) {
            const uint16_t value = std::rotl(static_cast<uint16_t>(farthest - i * step), rotation);
            bytes.push_back(static_cast<uint8_t>(value >> 8));
            bytes.push_back(static_cast<uint8_t>(value & 0xff));
        }
        std::filesystem::create_directories(folder.path() / "depth");
        writePng(folder.path() / "depth" / name, kSmallWidth, kSmallHeight, 16, 0, bytes);
        folder.write("depth.txt", "0.0 depth/" + name + "\n");
        return folder.path();
    };
    const SourceOptions depthOnly{.colour = "none"};
    const SourceOptions scaled{.colour = "none", .scale = 0.001};
    const auto first = [](const std::filesystem::path& folder, const SourceOptions& options) {
        return playedDepths(folder, options).front();
    };
    const std::string sun3d = "0000001-000000033369.png";
    const TemporaryFolder scene, flat, plain, coarse;
    CHECK(first(folderOf(scene, "1.png", 8200, 7, 3), depthOnly) == 8200);
    CHECK(first(scene.path(), scaled) == std::rotl(uint16_t{8200}, 3));
    CHECK(first(folderOf(flat, sun3d, 704, 0, 3), depthOnly) == 704); // one value
    CHECK(first(folderOf(plain, sun3d, 8200, 7, 0), depthOnly) == 8200);
    CHECK(first(folderOf(coarse, "1.png", 704, 0, 0), depthOnly) == 704); // one multiple of eight
}

TEST_CASE("Numbered images of a format that is not read are refused with the first one and the formats") {
    for (const char* name : {"000000.pfm", "000000.npz", "frame1.raw", "1.webp", "0.jpg"}) {
        const TemporaryFolder folder;
        addPair(folder, "a/0.png", "rgb/0.png", 500);
        folder.write(std::string("depth/") + name, "x");
        folder.write("depth/readme.txt", "x");
        mentions(recordingRefusal(folder.path(), lensIn(folder)),
                 "depth: depth images: none that is read; there is " + std::string(name) +
                     " (allowed: .png, .pgm, .tif");
    }
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "a/0.png", 500);
    folder.write("rgb/r-1.ppm", "x");
    mentions(
        recordingRefusal(folder.path(), lensIn(folder)),
        "rgb: colour images: none that is read; there is r-1.ppm (allowed: .png, .jpg, .jpeg with a number");
}

TEST_CASE("Names of seconds and nanoseconds without their leading zeros have a warning") {
    CHECK(lostZeros({"1305031102.175304000", "1305031102.5123457", "1305031102.45456789"}) == 1);
    CHECK(lostZeros({"1305031102.175304000", "1305031102.005123457", "1305031102.5123"}) == 0);
    CHECK(lostZeros({"1305031102.175304", "1305031102.512345"}) == 0);
    CHECK(lostZeros({"1.5", "1.25", "2.125"}) == 0);
    CHECK(lostZeros({"12-00-00.960", "12-00-00.993", "12-00-01.27"}) == 1); // milliseconds
    CHECK(lostZeros({"1305031102.5", "1305031102.25", "1305031102.125"}) == 0);
}
