// SPDX-License-Identifier: Apache-2.0
// Poses and lenses in text files of one matrix per image: their order and their unit.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/mentions.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kDepthMatrix = "7 0 3 0\n0 7 2 0\n0 0 1 0\n0 0 0 1\n";

// ScanNet's layout with one pose per frame.
void writeScan(const TemporaryFolder& folder, const std::vector<std::string>& poses,
               const std::string& lens = kDepthMatrix) {
    for (size_t i = 0; i < poses.size(); ++i) {
        const std::string number = std::to_string(i);
        addPair(folder, "depth/" + number + ".png", "color/" + number + ".png", 500);
        folder.write("pose/" + number + ".txt", poses[i]);
    }
    folder.write("intrinsic/intrinsic_depth.txt", lens);
    folder.write("intrinsic/intrinsic_color.txt", lens);
}

std::string shifted(double x) {
    return "1 0 0 " + std::to_string(x) + "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
}

std::string playedToEnd(const TemporaryFolder& folder) {
    RecordedCamera camera(folder.path());
    while (camera.next()) {
    }
    std::string all;
    for (const std::string& warning : camera.warnings()) {
        all += warning + "\n";
    }
    return all;
}

} // namespace

TEST_CASE("A pose with its position in the last row is refused as written column by column") {
    const TemporaryFolder folder;
    writeScan(folder, {shifted(0.1), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0.3 0 0 1\n", shifted(0.2)});
    mentions(playedToEnd(folder), "frame 1 skipped: ");
    mentions(playedToEnd(folder), "pose/1.txt: pose: its last row is not 0 0 0 1 (allowed: a matrix row by "
                                  "row, with the position in its last column)");
}

TEST_CASE("A pose whose matrix is mirrored, scaled or sheared is refused in these words") {
    const TemporaryFolder folder;
    const std::string end = "\n0 0 0 1\n";
    writeScan(folder, {"0 0 1 1\n-1 0 0 2\n0 -1 0 3" + end, "0 0 1 1\n1 0 0 2\n0 -1 0 3" + end,
                       "0 0 1.1 1\n-1.1 0 0 2\n0 -1.1 0 3" + end, "1 0.25 0 1\n0 1 0 2\n0 0 1 3" + end,
                       "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf" + end,
                       "0.001 0.003 1.002 1\n-1 0.002 0 2\n0 -0.998 0 3" + end});
    const std::string played = playedToEnd(folder);
    mentions(played, "pose/1.txt: pose: mirrored (allowed: a rotation matrix and a position)");
    mentions(played, "pose/2.txt: pose: scaled by 1.1 (allowed: a rotation matrix");
    mentions(played, "pose/3.txt: pose: sheared (allowed: ");
    mentions(played, "pose/4.txt: pose: not finite (allowed: ");
    CHECK(played.find("pose/0.txt") == std::string::npos);
    CHECK(played.find("pose/5.txt") == std::string::npos); // few digits
}

TEST_CASE("A pose of BOP whose matrix is mirrored is refused with the image and the field") {
    const TemporaryFolder bop;
    addPair(bop, "depth/0.png", "rgb/0.png", 500);
    bop.write("scene_camera.json", R"({"0": {"cam_K": [6, 0, 3, 0, 6, 2, 0, 0, 1], "depth_scale": 1,
        "cam_R_w2c": [0, 1, 0, 0, 0, -1, 1, 0, 0], "cam_t_w2c": [0, 0, 0]}})");
    mentions(recordingRefusal(bop.path()), "scene_camera.json: 0.cam_R_w2c: mirrored (allowed: a rotation");
}

TEST_CASE("A quaternion of poses.txt whose length is not 1 is refused with its length and the order") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    const auto refusal = [&](const std::string& quaternion) {
        folder.write("poses.txt", "0 0 0 0 " + quaternion + "\n0.1 0 0 0 0 0 0 1\n");
        return recordingRefusal(folder.path());
    };
    mentions(refusal("0 1 2 3"), "poses.txt: line 1: 0 0 0 0 0 1 2 3 (allowed: a quaternion qx qy qz qw, in "
                                 "this order, of length 1; its length is 3.742)");
    mentions(refusal("0 0 0 0.93"), "its length is 0.93");
    for (const char* few : {"0 0.7 0 0.7", "0.6 0.6 0.6 0"}) { // digits
        CHECK(refusal(few) == "");
    }
}

TEST_CASE("A lens that is written column by column is refused as such") {
    const TemporaryFolder folder;
    writeScan(folder, {shifted(0.0)}, "7 0 0 0\n0 7 0 0\n3 2 1 0\n0 0 0 1\n");
    mentions(recordingRefusal(folder.path()),
             "intrinsic_depth.txt: matrix: written column by column (allowed: fx 0 cx, 0 fy cy, 0 0 1");
    const TemporaryFolder bop;
    addPair(bop, "depth/0.png", "rgb/0.png", 500);
    bop.write("scene_camera.json", R"({"0": {"cam_K": [6, 0, 0, 0, 6, 0, 3, 2, 1], "depth_scale": 1}})");
    mentions(
        recordingRefusal(bop.path()),
        "scene_camera.json: 0.cam_K: written column by column (allowed: row by row, fx 0 cx, 0 fy cy, 0 0 1");
}

TEST_CASE(
    "A matrix that is no lens is refused with the element and its value, in every layout that has one") {
    for (const auto& [rows, fault] : {std::pair("6 0 3, 0 -6.5 2, 0 0 1", "fy is -6.5"),
                                      {"0 0 3, 0 6 2, 0 0 1", "fx is 0"},
                                      {"6 0 3, 0 6 2, 0 0 0", "its last row is 0 0 0"},
                                      {"12 0 6, 0 12 4, 0 0 2", "its last row is 0 0 2"}}) {
        const TemporaryFolder matrix, bop, frames;
        std::string text = rows, info = rows;
        std::ranges::replace(text, ',', '\n');
        addPair(matrix, "depth/0.png", "rgb/0.png", 500);
        matrix.write("cam_K.txt", text + "\n");
        mentions(recordingRefusal(matrix.path()),
                 "cam_K.txt: matrix: " + std::string(fault) + " (allowed: fx 0 cx");
        std::ranges::replace(text, '\n', ' ');
        addPair(bop, "depth/0.png", "rgb/0.png", 500);
        std::string list = text;
        for (size_t at = list.find(' '); at != std::string::npos; at = list.find(' ', at)) {
            list.replace(at, list[at + 1] == ' ' ? 2 : 1, ",");
        }
        bop.write("scene_camera.json", R"({"0": {"cam_K": [)" + list + R"(], "depth_scale": 1}})");
        mentions(recordingRefusal(bop.path()),
                 "scene_camera.json: 0.cam_K: " + std::string(fault) + " (allowed: row by");
        addPair(frames, "frame-000000.depth.png", "frame-000000.color.png", 500);
        for (size_t at = info.find(','); at != std::string::npos; at = info.find(',')) {
            info.replace(at, 1, " 0");
        }
        frames.write("info.txt", "m_depthWidth = 7\nm_depthHeight = 5\nm_depthShift = 1000\n"
                                 "m_calibrationDepthIntrinsic = " +
                                     info + " 0 0 0 0 1\n");
        mentions(recordingRefusal(frames.path(), {.colour = "none"}),
                 "info.txt: m_calibrationDepthIntrinsic: " + info);
    }
}

TEST_CASE("Poses of images in millimetres have a warning, and those in metres have none") {
    const auto warned = [](const std::vector<std::string>& poses) {
        const TemporaryFolder folder;
        writeScan(folder, poses);
        return playedToEnd(folder);
    };
    CHECK(warned({shifted(0.0), shifted(0.1), shifted(0.3)}) == "");
    CHECK(warned({shifted(20.0), shifted(20.9), shifted(20.95)}) == "");
    CHECK(warned({shifted(0.0), shifted(3.0), shifted(3.01), shifted(3.02)}) == ""); // one jump
    mentions(warned({shifted(0.0), shifted(10.0), shifted(20.0)}),
             "the pose of 1.png: the camera moves 10 m from one image to the next (poses in millimetres?)");
    mentions(warned({shifted(1500.0), shifted(1500.2)}),
             "the pose of 0.png: the camera is 1500 m from the origin (poses in millimetres?)");
}

TEST_CASE("A poses.txt whose comment names its columns in another order is refused with that comment") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    const auto refusal = [&](const std::string& head) {
        folder.write("poses.txt", head + "\n0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n");
        return recordingRefusal(folder.path());
    };
    for (const char* head :
         {"# timestamp px py pz qw qx qy qz", "# t pos_x pos_y pos_z quat_w quat_x quat_y quat_z",
          "#timestamp [s],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []",
          "#timestamp [s] p_RS_R_x [m] p_RS_R_y [m] p_RS_R_z [m] q_RS_w [] q_RS_x [] q_RS_y [] q_RS_z [] "
          "v_RS_R_x [m s^-1]",
          "# t, qw, qx, qy, qz, px, py, pz", "# time p.x p.y p.z q.w q.x q.y q.z", "# PX PY PZ QW QX QY QZ",
          "# timestamp, position (x, y, z), quaternion (w, x, y, z)",
          "# time position.x position.y position.z orientation.w orientation.x orientation.y orientation.z",
          "# by a rig\n#\n# stamp [s] x (m) y (m) z (m) qw qx qy qz", "# timestamp tx ty tz qw qx qy qz",
          "#t,x,y,z,q_w,q_x,q_y,q_z", "# poses of a rig\n# stamp qx qy qz qw tx ty tz",
          "\n# t [s], x, y, z, qw, qx, qy, qz",
          "# timestamp tx ty tz qx qy qz qw\n# here: t tx ty tz qw qx qy qz"}) {
        CAPTURE(head);
        mentions(refusal(head), "(allowed: columns in the order t tx ty tz qx qy qz qw)");
    }
    for (const char* head :
         {"# timestamp tx ty tz qx qy qz qw", "# ground truth trajectory", "# t x y z qx qy qz qw", "#", "",
          "# x is right, y is down, z is forward", "# qw is last: t tx ty tz qx qy qz qw",
          "# t, position tx ty tz, quaternion with qw last: qx qy qz", "# converted from qw qx qy qz",
          "# timestamp px py pz qx qy qz qw", "# t pos_x pos_y pos_z quat_x quat_y quat_z quat_w",
          "#timestamp [s] p_RS_R_x [m] p_RS_R_y [m] p_RS_R_z [m] q_RS_x [] q_RS_y [] q_RS_z [] q_RS_w []",
          "# timestamp, position (x, y, z), quaternion (x, y, z, w)", "# a new view of the quarry by hand, w",
          "# was t px py pz qw qx qy qz\n# now t px py pz qx qy qz qw",
          "# quaternions w x y z were reordered", "# max. error 0.1 px, y is up"}) {
        CAPTURE(head);
        CHECK(refusal(head) == "");
    }
}

TEST_CASE("Frames of ScanNet's benchmark play with both lenses under their names there, and their poses") {
    const TemporaryFolder folder;
    for (const char* number : {"000000", "000100"}) {
        addPair(folder, std::string("depth/") + number + ".png", std::string("color/") + number + ".png",
                501);
        folder.write(std::string("pose/") + number + ".txt", shifted(0.25));
    }
    folder.write("intrinsics_depth.txt", kDepthMatrix);
    folder.write("intrinsics_color.txt", "14 0 3 0\n0 14 2 0\n0 0 1 0\n0 0 0 1\n");
    folder.write("extrinsics_depth.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    RecordedCamera camera(folder.path());
    CHECK(camera.info().depth.fx == 7.0);
    CHECK(camera.info().colour.fx == 14.0);
    CHECK_FALSE(camera.info().registered);
    CHECK_FALSE(camera.info().poseless);
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] * camera.info().metresPerUnit == doctest::Approx(0.501));
    REQUIRE((*frame)->baseTcamera);
    CHECK((*frame)->baseTcamera->position.x == doctest::Approx(0.25));
    folder.write("extrinsics_color.txt", shifted(0.1));
    mentions(recordingRefusal(folder.path()), "extrinsics_color.txt: matrix: not the identity");
}
