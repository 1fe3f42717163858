// SPDX-License-Identifier: Apache-2.0
// Folders of other programs, scales that cannot be, and what is said behind a folder's name.
#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

namespace fs = std::filesystem;

uint32_t framesOf(RecordedCamera& camera, std::vector<double>& depths) {
    while (const auto frame = camera.next()) {
        depths.push_back((*frame)->depth[0] * camera.info().metresPerUnit);
    }
    return static_cast<uint32_t>(depths.size());
}

std::string layoutRefusal(const fs::path& folder, const SourceOptions& options = {}) {
    return testing::refusalOf([&] { RecordedCamera camera(folder, options); });
}

} // namespace

TEST_CASE("A folder of Open3D is played with its lens, in millimetres or by the scale given") {
    const TemporaryFolder folder;
    folder.write("camera_intrinsic.json",
                 R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6.5, 0, 3, 2, 1]})");
    addPair(folder, "depth/00000.png", "color/00000.png", 500);
    addPair(folder, "depth/00001.png", "color/00001.png", 600);
    RecordedCamera camera(folder.path());
    CHECK(camera.info().depth.fy == 6.5);
    CHECK(camera.info().depth.cx == 3.0);
    std::vector<double> depths;
    CHECK(framesOf(camera, depths) == 2);
    CHECK(depths.back() == doctest::Approx(0.6));
    CHECK(RecordedCamera(folder.path(), {.scale = 0.0002}).info().metresPerUnit == 0.0002);
    const std::string lens = R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6, 0, 3, 2, 1], )";
    folder.write("camera_intrinsic.json", lens + R"("depth_scale": 4000.0, "distortion": [0.1, 0, 0, 0]})");
    CHECK(RecordedCamera(folder.path()).info().metresPerUnit == 0.00025); // an L515
    CHECK(RecordedCamera(folder.path()).info().depth.distortion[0] == 0.1);
    folder.write("camera_intrinsic.json", lens + R"("depth_scale": 0.001})");
    CHECK(layoutRefusal(folder.path()).find("depth_scale: 0.001 (allowed: units per metre") !=
          std::string::npos);
    folder.write(
        "camera_intrinsic.json",
        R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 3, 0, 6.5, 2, 0, 0, 1]})"); // by rows
    CHECK(layoutRefusal(folder.path()).find("intrinsic_matrix") != std::string::npos);
}

TEST_CASE("A folder of BOP is played with the lens, scale and poses of scene_camera.json") {
    const TemporaryFolder folder;
    folder.write("scene_camera.json",
                 R"({"3": {"cam_K": [6, 0, 3, 0, 6.5, 2, 0, 0, 1], "depth_scale": 0.1,
                     "cam_R_w2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_w2c": [100, 0, 0]},
                     "10": {"cam_K": [6, 0, 3, 0, 6.5, 2, 0, 0, 1], "depth_scale": 1.0}})");
    addPair(folder, "depth/000003.png", "rgb/000003.png", 5000);
    addPair(folder, "depth/000010.png", "rgb/000010.png", 5000);
    RecordedCamera camera(folder.path());
    CHECK(camera.info().metresPerUnit == doctest::Approx(0.0001));
    CHECK(camera.info().depth.cy == 2.0);
    const auto frame = camera.next();
    REQUIRE(frame);
    REQUIRE((*frame)->baseTcamera);
    CHECK((*frame)->baseTcamera->position.x == doctest::Approx(-0.1));
    CHECK_FALSE(camera.next()); // another scale is never played with the first one's
    CHECK(camera.skipped() == 1);
    folder.write("lens.json", R"({"width": 7, "height": 5, "fx": 9, "fy": 9, "cx": 3, "cy": 2})");
    RecordedCamera other(folder.path(), {.intrinsics = folder.path() / "lens.json"});
    CHECK(other.info().depth.fx == 9.0);
    CHECK(other.info().metresPerUnit == doctest::Approx(0.0001)); // the folder's: the file has none
    CHECK(other.next().value()->baseTcamera.has_value());
}

TEST_CASE("A folder of 7-Scenes is played with its poses, and 65535 is no depth") {
    const TemporaryFolder folder;
    writeDepth(folder.path() / "frame-000000.depth.png", 640, 480, 65535);
    writeColour(folder.path() / "frame-000000.color.png", 640, 480, 1, 2, 3);
    folder.write("frame-000000.pose.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    writeDepth(folder.path() / "frame-000001.depth.png", 640, 480, 1000);
    writeColour(folder.path() / "frame-000001.color.png", 640, 480, 1, 2, 3);
    folder.write("frame-000001.pose.txt", "1 0 0\n0 1 0\n0 0 1\n"); // no position
    RecordedCamera camera(folder.path());
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[1000] == 0);
    REQUIRE((*frame)->baseTcamera);
    CHECK((*frame)->baseTcamera->position.x == 0.5);
    CHECK_FALSE(camera.next());
    REQUIRE(camera.warnings().size() == 2); // the first one is that of the lens
    CHECK(camera.warnings()[1].find("matrix: 9 numbers (allowed: 4 x 4)") != std::string::npos);
}

TEST_CASE("Images without a pose are skipped and named where others have one, in every layout with poses") {
    const std::string pose = "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    const TemporaryFolder scenes, bop, scanNet;
    std::string cameras;
    for (int i = 0; i < 3; ++i) {
        const std::string n = std::to_string(i), stem = "frame-00000" + n;
        writeDepth(scenes.path() / (stem + ".depth.png"), 640, 480, static_cast<uint16_t>(500 + i));
        writeColour(scenes.path() / (stem + ".color.png"), 640, 480, 1, 2, 3);
        addPair(bop, "depth/" + n + ".png", "rgb/" + n + ".png", static_cast<uint16_t>(500 + i));
        addPair(scanNet, "depth/" + n + ".png", "color/" + n + ".png", static_cast<uint16_t>(500 + i));
        cameras +=
            (i == 0 ? "\"" : ", \"") + n + R"(": {"cam_K": [6, 0, 3, 0, 6, 2, 0, 0, 1], "depth_scale": 1)";
        if (i != 1) {
            scenes.write(stem + ".pose.txt", pose);
            scanNet.write("pose/" + n + ".txt", pose);
            cameras += R"(, "cam_R_w2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_w2c": [100, 0, 0])";
        }
        cameras += "}";
    }
    bop.write("scene_camera.json", "{" + cameras + "}");
    for (const char* name : {"depth", "color"}) {
        scanNet.write(std::string("intrinsic/intrinsic_") + name + ".txt", "7 0 3\n0 7 2\n0 0 1\n");
    }
    for (const TemporaryFolder* folder : {&scenes, &bop, &scanNet}) {
        CHECK(playedDepths(folder->path()) == std::vector<uint16_t>{500, 502});
        RecordedCamera camera(folder->path());
        CHECK_FALSE(camera.info().poseless);
        while (camera.next()) {
        }
        REQUIRE(camera.warnings().size() == (folder == &scenes ? 2 : 1)); // that of the lens is first
        CHECK(camera.warnings().back() == "frame 1 skipped: it has no pose, but other images have");
    }
}

TEST_CASE("A depth scale given as units per metre is rejected with the number that is meant") {
    for (const char* scale : {"1000", "5000", "1.0", "0.5", "1e-9"}) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        std::string text = folder.read("intrinsics.json");
        text.replace(text.find("0.001"), 5, scale);
        folder.write("intrinsics.json", text);
        CHECK(layoutRefusal(folder.path()).find("1000 units per metre are 0.001") != std::string::npos);
    }
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    CHECK(layoutRefusal(folder.path(), {.scale = 1000.0}).find("1000 units per metre") != std::string::npos);
}

TEST_CASE("Stamps that are steps are no times: every frame is played, in the order of the index") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 8);
    std::string index;
    const char* const kSteps[] = {"0.0154", "0.0148", "0.0163", "0.0162",
                                  "0.0331", "0.0057", "0.0169", "0.0172"};
    for (int i = 0; i < 8; ++i) {
        const std::string n = std::to_string(i) + ".png";
        index += std::string(kSteps[i]) + " rgb/" + n + " " + kSteps[i] + " depth/" + n + "\n";
    }
    folder.write("associations.txt", index);
    RecordedCamera camera(folder.path());
    uint32_t next = 0;
    double last = -1.0;
    while (const auto frame = camera.next()) {
        CHECK((*frame)->index == next++);
        CHECK((*frame)->captureTime > last);
        last = (*frame)->captureTime;
    }
    CHECK(next == 8);
    folder.write("poses.txt", "0 0 0 0 0 0 0 1\n");
    CHECK(layoutRefusal(folder.path()).find("poses.txt") != std::string::npos);
}

TEST_CASE("Start and duration cut a folder, and another file gives the lens") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 10); // 0.1 s apart
    RecordedCamera camera(folder.path(), {.start = 0.25, .duration = 0.3});
    std::vector<double> depths;
    CHECK(framesOf(camera, depths) == 3);
    CHECK(depths.front() == doctest::Approx(1.003));
    std::string other = folder.read("intrinsics.json");
    other.replace(other.find("0.001"), 5, "0.002");
    folder.write("other.json", other);
    fs::remove(folder.path() / "intrinsics.json");
    CHECK(layoutRefusal(folder.path()).find("intrinsics=FILE") != std::string::npos);
    const fs::path lens = folder.path() / "other.json";
    CHECK(
        layoutRefusal(folder.path(), {.depth = "/x", .intrinsics = lens}).find("depth: /x (allowed: only") !=
        std::string::npos);
    CHECK(layoutRefusal(folder.path(), {.info = "/x", .intrinsics = lens}).find("info: /x") !=
          std::string::npos);
    CHECK(layoutRefusal(folder.path(), {.colour = "/x", .intrinsics = lens}).find("colour: /x") !=
          std::string::npos);
    CHECK(RecordedCamera(folder.path(), {.intrinsics = folder.path() / "other.json"}).info().metresPerUnit ==
          0.002);
}

TEST_CASE("What is said behind a recording's name is split from it, and wrong values are named") {
    const SourceRequest all =
        parseSource("a,b.bag,depth=/d,colour=none,info=/i,intrinsics=i.json,extrinsics=e.json,"
                    "scale=0.001,start=2,duration=3");
    CHECK(all.file == "a,b.bag");
    CHECK(all.options.depth == "/d");
    CHECK(all.options.colour == "none");
    CHECK(all.options.info == "/i");
    CHECK(all.options.intrinsics == "i.json");
    CHECK(all.options.extrinsics == "e.json");
    CHECK(all.options.scale == 0.001);
    CHECK(all.options.start == 2.0);
    CHECK(all.options.duration == 3.0);
    CHECK(parseSource("plain/folder").file == "plain/folder");
    CHECK_THROWS_WITH_AS(parseSource("a,scale=x"), doctest::Contains("scale: x"), BadInput);
    CHECK_THROWS_WITH_AS(parseSource("a,scale=0"), doctest::Contains("above 0"), BadInput);
    CHECK_THROWS_WITH_AS(parseSource("a,start=-1"), doctest::Contains("at least 0"), BadInput);
    CHECK_THROWS_WITH_AS(parseSource("a,depth="), doctest::Contains("depth: nothing"), BadInput);
    CHECK_THROWS_WITH_AS(parseSource("a,depth=/x,depth=/y"), doctest::Contains("given twice"), BadInput);
}

TEST_CASE("Fields with colour in their name may be spelled the British way") {
    const TemporaryFolder folder;
    writeDepth(folder.path() / "depth/0.png", kSmallWidth, kSmallHeight, 500);
    folder.write("depth.txt", "0 depth/0.png\n");
    folder.write("intrinsics.json", R"({"width": 7, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2,
        "depth_scale_m_per_unit": 0.001, "registered_to_colour": true, "has_colour": false})");
    CHECK(playedDepths(folder.path()) == std::vector<uint16_t>{500});
    CHECK_FALSE(RecordedCamera(folder.path()).info().hasColour);
}

TEST_CASE("Lines of associations.txt may name depth first, as ICL-NUIM writes them") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    folder.write("associations.txt", "0.0 depth/0.png 0.0 rgb/0.png\n0.1 depth/1.png 0.1 rgb/1.png\n");
    RecordedCamera camera(folder.path());
    CHECK(camera.next());
    CHECK(camera.next());
    CHECK(camera.skipped() == 0);
}

TEST_CASE("Without colour every layout plays with colour=none, and says so when it is not given") {
    const TemporaryFolder open3d, bop, scanNet, scenes, tum, listed;
    for (const TemporaryFolder* folder : {&open3d, &bop, &scanNet, &tum, &listed}) {
        writeDepth(folder->path() / "depth/0.png", kSmallWidth, kSmallHeight, 500);
    }
    open3d.write("camera_intrinsic.json",
                 R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6.5, 0, 3, 2, 1]})");
    bop.write("scene_camera.json", R"({"0": {"cam_K": [6, 0, 3, 0, 6, 2, 0, 0, 1], "depth_scale": 1}})");
    scanNet.write("intrinsic/intrinsic_depth.txt", "7 0 3\n0 7 2\n0 0 1\n");
    writeDepth(scenes.path() / "frame-000000.depth.png", 640, 480, 500);
    tum.write("intrinsics.json", kSmallIntrinsics);
    tum.write("depth.txt", "0 depth/0.png\n");
    std::string stamps = kSmallIntrinsics;
    listed.write("intrinsics.json", stamps.insert(1, R"("depth_stamps_s": [0.5], )"));
    for (const TemporaryFolder* folder : {&open3d, &bop, &scanNet, &scenes, &tum, &listed}) {
        CHECK(recordingRefusal(folder->path()).find("colour=none after the folder name") !=
              std::string::npos);
        CHECK(playedDepths(folder->path(), {.colour = "none"}) == std::vector<uint16_t>{500});
        CHECK_FALSE(RecordedCamera(folder->path(), {.colour = "none"}).info().hasColour);
    }
}

TEST_CASE("A ScanNet folder plays with both lenses and its poses, without the frames whose pose was lost") {
    const TemporaryFolder folder;
    for (const char* number : {"0", "1", "10"}) {
        addPair(folder, std::string("depth/") + number + ".png", std::string("color/") + number + ".png",
                500);
        fs::create_directories(folder.path() / "pose");
        const bool lost = std::string(number) == "1";
        folder.write(std::string("pose/") + number + ".txt",
                     lost ? "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n0 0 0 1\n"
                          : "1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    }
    fs::create_directories(folder.path() / "intrinsic");
    folder.write("intrinsic/intrinsic_depth.txt", "7 0 3 0\n0 7.5 2 0\n0 0 1 0\n0 0 0 1\n");
    folder.write("intrinsic/intrinsic_color.txt", "14 0 3.5\n0 14 2.5\n0 0 1\n");
    RecordedCamera camera(folder.path());
    CHECK(camera.info().depth.fy == 7.5);
    CHECK(camera.info().depth.cx == 3.0);
    CHECK(camera.info().colour.fx == 14.0);
    CHECK_FALSE(camera.info().registered);
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] * camera.info().metresPerUnit == doctest::Approx(0.5));
    REQUIRE((*frame)->baseTcamera);
    CHECK((*frame)->baseTcamera->position.x == 0.25);
    CHECK(camera.next());
    CHECK_FALSE(camera.next());
    CHECK(camera.skipped() == 1);
    folder.write("intrinsic/extrinsic_color.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    CHECK(layoutRefusal(folder.path()).find("not the identity") != std::string::npos);
    folder.write("lens.json", kSmallIntrinsics); // as the message advises
    RecordedCamera other(folder.path(), {.intrinsics = folder.path() / "lens.json"});
    CHECK(other.info().depth.fx == 6.5);
    CHECK(other.info().registered);
    const auto posed = other.next();
    REQUIRE(posed);
    REQUIRE((*posed)->baseTcamera);
    CHECK((*posed)->baseTcamera->position.x == 0.25);
}
