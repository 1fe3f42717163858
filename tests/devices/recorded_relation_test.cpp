// SPDX-License-Identifier: Apache-2.0
// What of a folder stays whose lens is replaced by a file: how colour relates to depth, and the unit.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kLensAlone = R"({"width": 7, "height": 5, "fx": 9, "fy": 9, "cx": 3, "cy": 2,
                                 "depth_scale_m_per_unit": 0.001)";
const std::string kOwnLenses =
    R"({"depth": {"width": 7, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2},
        "color": {"width": 7, "height": 5, "fx": 5, "fy": 5, "cx": 3, "cy": 2},
        "depth_scale_m_per_unit": 0.001,
        "extrinsics_topic_tf": {"Color": {"t": [0.015, 0, 0], "q_xyzw": [0, 0, 0, 1]}}})";
const std::string kRestOfRows = " 0 3 0 0 6 2 0 0 0 1 0 0 0 0 1\n";
const std::string kTwoInfos = "m_colorWidth = 7\nm_colorHeight = 5\nm_depthWidth = 7\nm_depthHeight = 5\n"
                              "m_depthShift = 1000\nm_calibrationColorIntrinsic = 5" +
                              kRestOfRows + "m_calibrationDepthIntrinsic = 6" + kRestOfRows;

CameraInfo playedInfo(const TemporaryFolder& folder, const std::string& lens, SourceOptions options = {}) {
    folder.write("lens.json", lens);
    options.intrinsics = folder.path() / "lens.json";
    RecordedCamera camera(folder.path(), options);
    CHECK(camera.next());
    return camera.info();
}

// The recorded pose of colour is its own, x to the right [m].
void checkKept(const TemporaryFolder& folder, double x) {
    const CameraInfo kept = playedInfo(folder, kLensAlone + "}");
    CHECK(kept.depth.fx == 9.0);
    CHECK(kept.colour.fx == 5.0);
    CHECK_FALSE(kept.registered);
    CHECK(kept.colourTdepth.position.x == x);
    const CameraInfo stated = playedInfo(folder, kLensAlone + R"(, "registered_to_color": true})");
    CHECK(stated.colour.fx == 9.0);
    CHECK(stated.registered);
    CHECK_FALSE(playedInfo(folder, kLensAlone + "}", {.colour = "none"}).hasColour);
}

// The folder's own files state 0.1 mm per unit, in whatever form.
void checkUnit(const TemporaryFolder& folder) {
    const std::string lens = R"({"width": 7, "height": 5, "fx": 9, "fy": 9, "cx": 3, "cy": 2})";
    const testing::Listening log;
    CHECK(playedInfo(folder, lens).metresPerUnit == doctest::Approx(1e-4));
    CHECK(playedInfo(folder, kLensAlone + "}", {.scale = 0.002}).metresPerUnit == 0.002);
    CHECK(log.count("the depth unit of") == 0);
    CHECK(playedInfo(folder, kLensAlone + "}").metresPerUnit == doctest::Approx(1e-4));
    CHECK(log.count("the depth unit of lens.json is 0.001 m, but that of ") == 1);
    CHECK(log.count(" is 0.0001 m, which is used; scale=M after the recording's name") == 1);
}

} // namespace

TEST_CASE("A file of one lens replaces depth only in a folder of two lenses, whose relation stays") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    folder.write("intrinsics.json", kOwnLenses);
    checkKept(folder, 0.015);
}

TEST_CASE("A file of one lens replaces depth only in a folder of images frame-N with two lenses") {
    const TemporaryFolder folder;
    addPair(folder, "frame-000000.depth.png", "frame-000000.color.png", 500);
    folder.write("info.txt", kTwoInfos);
    checkKept(folder, 0.0);
}

TEST_CASE(
    "A file of one lens replaces depth only in a folder of ScanNet and in one of Open3D with two lenses") {
    const TemporaryFolder scanNet, open3d;
    addPair(scanNet, "depth/0.png", "color/0.png", 500);
    std::filesystem::create_directories(scanNet.path() / "intrinsic");
    scanNet.write("intrinsic/intrinsic_depth.txt", "6 0 3\n0 6 2\n0 0 1\n");
    scanNet.write("intrinsic/intrinsic_color.txt", "5 0 3\n0 5 2\n0 0 1\n");
    checkKept(scanNet, 0.0);
    addPair(open3d, "depth/0.png", "color/0.png", 500);
    open3d.write("camera_intrinsic.json", kOwnLenses);
    checkKept(open3d, 0.015);
}

TEST_CASE(
    "A file of one lens is the lens of colour, too, where the folder's depth is registered or has no lens") {
    const TemporaryFolder registered, bare;
    writeSmallRecording(registered, 1);
    writeSmallRecording(bare, 1);
    std::filesystem::remove(bare.path() / "intrinsics.json");
    for (const TemporaryFolder* folder : {&registered, &bare}) {
        CHECK(playedInfo(*folder, kLensAlone + "}").registered);
        CHECK(playedInfo(*folder, kLensAlone + "}").colour.fx == 9.0);
    }
}

TEST_CASE("Two lenses whose q_xyzw turns colour away from depth are refused with the field and the order") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    std::string text = kOwnLenses;
    const std::string unit = "[0, 0, 0, 1]";
    folder.write("intrinsics.json", text.replace(text.find(unit), unit.size(), "[0.9999, 0, 0, 0.01]"));
    mentions(recordingRefusal(folder.path()), "intrinsics.json: extrinsics_topic_tf.Color.q_xyzw: "
                                              "[0.9999,0,0,0.01] (allowed: x y z w, in this order, with ");
}

TEST_CASE("A file of one lens is refused where the folder's relation of depth and colour cannot be read") {
    const TemporaryFolder folder;
    addPair(folder, "frame-000000.depth.png", "frame-000000.color.png", 500);
    folder.write("info.txt", kTwoInfos + "m_calibrationColorExtrinsic = 0.9 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    folder.write("lens.json", kLensAlone + "}");
    const std::string refused = recordingRefusal(folder.path(), {.intrinsics = folder.path() / "lens.json"});
    mentions(refused, "lens.json: registered_to_color: missing (allowed: true, or blocks depth and color");
    mentions(refused, "m_calibrationColorExtrinsic: 0.9");
    CHECK(playedInfo(folder, kLensAlone + R"(, "registered_to_color": true})").registered);
    CHECK_FALSE(playedInfo(folder, kLensAlone + "}", {.colour = "none"}).hasColour);
}

TEST_CASE("A relation of colour that cannot be read is refused with and without an index alike") {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "rgb/0.png", 500);
    std::string text = kOwnLenses;
    const std::string unit = "[0, 0, 0, 1]";
    folder.write("intrinsics.json", text.replace(text.find(unit), unit.size(), "[0.9999, 0, 0, 0.01]"));
    folder.write("lens.json", kLensAlone + "}");
    const SourceOptions options{.intrinsics = folder.path() / "lens.json"};
    const std::string refused = recordingRefusal(folder.path(), options);
    mentions(refused, "lens.json: registered_to_color: missing (allowed: true, or blocks depth and color");
    folder.write("associations.txt", "0.0 rgb/0.png 0.0 depth/0.png\n");
    CHECK(recordingRefusal(folder.path(), options) == refused);
}

TEST_CASE(
    "The unit that a folder's files state stays where a file replaces the lens; two that differ are named") {
    const TemporaryFolder open3d, indexed, bop, frames, tum;
    const std::string mark = R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6, 0, 3, 2, 1],
                                 "depth_scale": 10000})";
    addPair(open3d, "depth/0.png", "color/0.png", 500);
    open3d.write("camera_intrinsic.json", mark);
    checkUnit(open3d);
    writeSmallRecording(indexed, 1);
    std::filesystem::remove(indexed.path() / "intrinsics.json");
    indexed.write("camera_intrinsic.json", mark);
    checkUnit(indexed);
    addPair(bop, "depth/0.png", "rgb/0.png", 500);
    bop.write("scene_camera.json", R"({"0": {"cam_K": [6, 0, 3, 0, 6, 2, 0, 0, 1], "depth_scale": 0.1}})");
    checkUnit(bop);
    addPair(frames, "frame-000000.depth.png", "frame-000000.color.png", 500);
    std::string info = kTwoInfos;
    frames.write("info.txt", info.replace(info.find("1000"), 4, "10000"));
    checkUnit(frames);
    writeSmallRecording(tum, 1);
    std::string own = kSmallIntrinsics;
    tum.write("intrinsics.json", own.replace(own.find("0.001"), 5, "0.0001"));
    checkUnit(tum);
}

TEST_CASE(
    "A unit of the folder that cannot be read is refused, unless a file of a lens or scale=M states one") {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "color/0.png", 500);
    folder.write("camera_intrinsic.json", R"({"intrinsic_matrix": [], "depth_scale": 0.001})");
    folder.write("lens.json", R"({"width": 7, "height": 5, "fx": 9, "fy": 9, "cx": 3, "cy": 2,
                                  "registered_to_color": true})");
    const std::filesystem::path lens = folder.path() / "lens.json";
    mentions(recordingRefusal(folder.path(), {.intrinsics = lens}),
             "camera_intrinsic.json: depth_scale: 0.001 (allowed: units per metre, 10 to 1000000)");
    CHECK(playedDepths(folder.path(), {.intrinsics = lens, .scale = 0.001}).size() == 1);
    CHECK(playedInfo(folder, kLensAlone + "}").metresPerUnit == 0.001);
}
