// SPDX-License-Identifier: Apache-2.0
// What the program says about folders that it cannot read as they are meant.
#include "devices/recorded/recorded_camera.h"
#include "devices/recorded/unread_poses.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Stamps, in this many units per second.
void writeStamps(const TemporaryFolder& folder, long perSecond) {
    writeSmallRecording(folder, 3);
    std::string index;
    for (long i = 0; i < 3; ++i) {
        const std::string stamp = std::to_string(1700000000 * perSecond + i * perSecond / 30 + i),
                          name = std::to_string(i) + ".png";
        index += stamp + " rgb/" + name + " " + stamp + " depth/" + name + "\n";
    }
    folder.write("associations.txt", index);
}

} // namespace

TEST_CASE("Stamps that look like milli, micro or nanoseconds are named by that unit") {
    for (const auto& [perSecond, unit] :
         {std::pair(1000L, "milliseconds"), {1000000L, "microseconds"}, {1000000000L, "nanoseconds"}}) {
        const TemporaryFolder folder;
        writeStamps(folder, perSecond);
        const auto warnings = RecordedCamera(folder.path()).warnings();
        REQUIRE(warnings.size() == 1);
        mentions(warnings[0], std::string("stamps are read as seconds, but look like ") + unit);
        folder.write("poses.txt", "1700000000.0 0 0 0 0 0 0 1\n1700000000.1 0.01 0 0 0 0 0 1\n");
        mentions(recordingRefusal(folder.path()), std::string("(stamps of images in ") + unit + "?)");
    }
}

TEST_CASE("Stamps in milliseconds are named as such where few pairs of depth and colour are found by them") {
    for (const int apart : {0, 1}) { // of the first pair [ms]
        const TemporaryFolder folder;
        writeSmallRecording(folder, 5);
        std::filesystem::remove(folder.path() / "associations.txt");
        std::string depth, colour;
        for (int i = 0; i < 5; ++i) {
            const std::string name = std::to_string(i) + ".png\n";
            depth += std::to_string(1700000000000 + 33 * i) + " depth/" + name;
            colour += std::to_string(1700000000000 + 34 * i + apart) + " rgb/" + name;
        }
        folder.write("depth.txt", depth);
        folder.write("rgb.txt", colour);
        const testing::Listening log;
        const std::string refused = recordingRefusal(folder.path());
        const std::string words = "stamps are read as seconds, but look like milliseconds";
        CHECK(log.count("4 of 5 depth images have no colour image within 0.02 s: they are not played; " +
                        words) == 1);
        CHECK((refused.find(words) != std::string::npos) == (apart == 1));
    }
}

TEST_CASE("Poses whose stamps look like nanoseconds of those of the images are named by that unit") {
    const TemporaryFolder folder;
    writeStamps(folder, 1);
    folder.write("poses.txt", "1700000000000000000 0 0 0 0 0 0 1\n1700000000100000000 0.01 0 0 0 0 0 1\n");
    mentions(recordingRefusal(folder.path()), "(stamps of poses.txt in nanoseconds?)");
    folder.write("poses.txt", "1600000000 0 0 0 0 0 0 1\n1600000000.1 0.01 0 0 0 0 0 1\n");
    CHECK(recordingRefusal(folder.path()).find("seconds?") == std::string::npos);
}

TEST_CASE("Decimal commas in an index and in poses are named as such") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    folder.write("associations.txt", "0,0 rgb/0.png 0,0 depth/0.png\n");
    mentions(recordingRefusal(folder.path()), "line 1 has a stamp with a comma; numbers have decimal points");
    std::filesystem::remove(folder.path() / "associations.txt");
    folder.write("depth.txt", "0,0 depth/0.png\n");
    folder.write("rgb.txt", "0,0 rgb/0.png\n");
    const testing::Listening log;
    recordingRefusal(folder.path());
    CHECK(log.count("depth.txt: line 1 has a stamp with a comma; numbers have decimal points: skipped") == 1);
    folder.write("associations.txt", "0.0 rgb/0.png 0.0 depth/0.png\n");
    folder.write("poses.txt", "0,0 0 0 0 0 0 0 1\n");
    mentions(recordingRefusal(folder.path()),
             "(allowed: eight finite numbers t tx ty tz qx qy qz qw, with decimal points and between spaces");
}

TEST_CASE("Columns between commas, semicolons or quotation marks are named once, with the first line") {
    for (const auto& [line, fault] :
         {std::pair("0.0,depth/0.png", "has columns between ','; they stand between spaces"),
          {"0.0, depth/0.png", "has columns between ','; they stand between spaces"},
          {"depth/0.png,0.0", "has columns between ','; they stand between spaces"},
          {"0.0;depth/0.png", "has columns between ';'; they stand between spaces"},
          {"\"0.0\" \"depth/0.png\"", "has quotation marks; columns stand between spaces, without them"},
          {"depth/0.png", "is not 't path'"}}) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        std::filesystem::remove(folder.path() / "associations.txt");
        folder.write("rgb.txt", "0.0 rgb/0.png\n");
        folder.write("depth.txt", std::string("# t path\n") + line + "\n" + line + "\n" + line + "\n");
        const testing::Listening log;
        mentions(recordingRefusal(folder.path()), "no pair of images");
        CHECK(log.count("depth.txt: line 2 " + std::string(fault) + ": skipped, as are 2 others; it is " +
                        line) == 1);
        CHECK(log.count(": skipped") == 1);
    }
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    folder.write("associations.txt", "0.0,rgb/0.png,0.0,depth/0.png\n");
    mentions(recordingRefusal(folder.path()), "line 1 has columns between ','; they stand between spaces");
}

TEST_CASE("Poses in Fathom's format beside images that have no stamps are named with what they need") {
    const TemporaryFolder folder;
    folder.write("poses.txt", "0 0 0 0 0 0 0 1\n");
    folder.write("odometry.txt", "");
    mentions(unreadPoses(folder.path()),
             "poses.txt is not read (it is read by the stamps of an index: intrinsics.json and "
             "associations.txt, or depth.txt and rgb.txt)");
}

TEST_CASE("Depth that is first in associations.txt is found by the part of the paths that differs") {
    const TemporaryFolder folder;
    folder.write("intrinsics.json", kSmallIntrinsics);
    addPair(folder, "depth_cam/depth/0.png", "depth_cam/rgb/0.png", 500);
    folder.write("associations.txt", "0.0 depth_cam/depth/0.png 0.0 depth_cam/rgb/0.png\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{500});
    folder.write("associations.txt", "0.0 depth_cam/rgb/0.png 0.0 depth_cam/depth/0.png\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{500});
    addPair(folder, "frames/0_depth.png", "frames/0_rgb.png", 501);
    folder.write("associations.txt", "0.0 frames/0_depth.png 0.0 frames/0_rgb.png\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{501});
}

TEST_CASE("Images of associations.txt whose names do not tell depth are refused with the order that counts") {
    const TemporaryFolder folder;
    folder.write("intrinsics.json", kSmallIntrinsics);
    addPair(folder, "disp/0.png", "left/0.png", 500);
    folder.write("associations.txt", "0.0 disp/0.png 0.0 left/0.png\n");
    mentions(recordingRefusal(folder.path()),
             "(colour comes first in associations.txt where no path names depth)");
    folder.write("associations.txt", "0.0 left/0.png 0.0 disp/0.png\n");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{500});
}

TEST_CASE("A folder of point clouds is refused with the name of one, as clouds play one by one") {
    for (const char* name : {"b.pcd", "b.PLY"}) {
        const TemporaryFolder folder;
        folder.write(name, "x");
        folder.write("readme.txt", "x");
        mentions(recordingRefusal(folder.path()), "a folder of point clouds (allowed: one cloud, " +
                                                      (folder.path() / name).string() +
                                                      "; or clouds in a bag)");
    }
}

TEST_CASE("Text files of a folder in UTF-16 are refused as such") {
    for (const char* name : {"intrinsics.json", "associations.txt", "poses.txt"}) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        folder.write(name, std::string("\xff\xfe{\0 \0", 6));
        mentions(recordingRefusal(folder.path()),
                 std::string(name) + ": content: UTF-16 text: save it as UTF-8");
    }
}

TEST_CASE("A folder whose depth images lie elsewhere than in depth/ is refused with the place of them") {
    const auto refusal = [](const char* depth, bool lens) {
        const TemporaryFolder folder;
        addPair(folder, depth, "frames/frame0.png", 500);
        folder.write("lens.json", kSmallIntrinsics);
        return recordingRefusal(folder.path(),
                                {.intrinsics = lens ? (folder.path() / "lens.json").string() : ""});
    };
    for (const bool lens : {false, true}) {
        mentions(refusal("lowres_depth/1.png", lens),
                 "depth images: in lowres_depth (allowed: in a folder depth, ");
        mentions(refusal("depths/frame_1.png", lens), "depth images: in depths (");
        mentions(refusal("results/depth000000.png", lens), "depth images: in results (");
        mentions(refusal("000_depth.png", lens), "depth images: in the folder itself (");
        CHECK(refusal("disp/1.png", lens).find("depth images: in") == std::string::npos);
    }
}

TEST_CASE("Files of poses and of single images are not named as the lens of a folder") {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "rgb/0.png", 500);
    for (const char* name : {"poses/cam_0000.txt", "labels/cam_0001.json", "depth/camera_0001.npy"}) {
        folder.write(name, "{}");
        mentions(recordingRefusal(folder.path()), "/intrinsics.json: file: missing (allowed: ");
    }
}

TEST_CASE("An index with the backslashes of Windows names the same images") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    const std::vector<uint16_t> both{1000, 1001};
    folder.write("associations.txt",
                 "0.0 rgb\\0.png 0.0 depth\\0.png\n0.1 .\\rgb\\1.png 0.1 .\\depth\\1.png\n");
    CHECK(playedDepths(folder.path()) == both);
    std::filesystem::remove(folder.path() / "associations.txt");
    folder.write("depth.txt", "0.0 depth\\0.png\n0.1 depth\\1.png\n0.2 ..\\2.png\n");
    folder.write("rgb.txt", "0.0 rgb\\0.png\n0.1 rgb\\1.png\n");
    CHECK(playedDepths(folder.path()) == both); // the third one points outside
    writeDepth(folder.path() / "depth\\0.png", kSmallWidth, kSmallHeight, 700); // a name with a backslash
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{700, 1001});
}

TEST_CASE("A key that intrinsics.json gives twice is refused by its path, also in a block") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    const auto refused = [&](const std::string& lens) {
        folder.write("intrinsics.json", lens);
        return recordingRefusal(folder.path());
    };
    const std::string lens = kSmallIntrinsics.substr(0, kSmallIntrinsics.size() - 1);
    mentions(refused(lens + R"(, "fx": 13})"),
             "intrinsics.json: fx: given twice (allowed: each key once in an object)");
    mentions(refused(lens + R"(, "more": [[{"a": 1}, {"a": {"b": 1, "c": 2, "b": 3}}]]})"),
             "intrinsics.json: more.a.b: given twice (allowed: ");
    CHECK(refused(lens + R"(, "more": [{"a": {"b": 1}, "b": {"a": 1}}, {"a": {"b": 1}}, 1]})") == "");
}
