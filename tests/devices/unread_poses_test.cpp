// SPDX-License-Identifier: Apache-2.0
// Poses of a moving camera that are not read are named, in folders and in bags.
#include "devices/recorded/unread_poses.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string namedPoses(const std::string& name, const std::string& text, size_t images = 0) {
    const TemporaryFolder folder;
    folder.write(name, text);
    return unreadPoses(folder.path(), images);
}

// A transform of /tf, or of /tf_static, at x [m].
void addLink(BagMaker& maker, const std::string& topic, double t, const std::string& parent,
             const std::string& child, double x) {
    Out link{Out().put(uint32_t{1}).bytes + stampedHeader(t, parent)};
    link.text(child).bytes += transformMessage(x, 0.0, 0.0);
    maker.add(topic, "tf2_msgs/TFMessage", t, link.bytes);
}

BagMaker registeredImages() {
    BagMaker maker;
    addStream(maker, "/camera/depth/image_raw", depthImage(500, "optical"), {.frame = "optical"});
    addStream(maker, "/camera/color/image_raw", redImage("optical"), {.frame = "optical"});
    return maker;
}

// The warnings about a camera that counts as fixed.
std::string fixedWarnings(const BagMaker& maker) {
    const TemporaryFolder folder;
    std::string all;
    for (const std::string& line : playStreams(folder, maker).warnings()) {
        all += line.find("counts as fixed") != std::string::npos ? line + "\n" : "";
    }
    return all;
}

void addPose(BagMaker& maker, const std::string& topic, const std::string& type, double t, double x) {
    Out message{stampedHeader(t, "world")};
    if (type != "geometry_msgs/PoseStamped" && type != "geometry_msgs/PoseWithCovarianceStamped") {
        message.text("camera");
    }
    message.bytes += transformMessage(x, 0.0, 0.0);
    maker.add(topic, type, t, message.bytes);
}

} // namespace

TEST_CASE("A text of one pose per line is named as poses that are not read, whatever its name") {
    for (const char* line : {"1.5 0.1 0 0 0 0 0 1\n",                  // stamp, position, quaternion
                             "0.1 0 0 0 0.6 0 0.8\n",                  // position, quaternion
                             "1 0 0 0.1 0 1 0 0 0 0 1 0\n",            // rows of a matrix, as of KITTI
                             "17 1 0 0 0.1 0 1 0 0 0 0 1 0\n",         // with a number or a stamp
                             "1 0 0 0.1 0 1 0 0 0 0 1 0 0 0 0 1\n",    // four rows
                             "1,0.1,0,0,0,0,0.6,0.8\n",                // with commas
                             "rgb/1.png 0.1 0 0 0 0 0 1\n",            // with an image
                             "1 0.5 0.5 0.5 0.5 0 0 1 1 a.png\n0 1\n", // as of COLMAP
                             "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n\n"}) {     // rows on lines of their own
        CAPTURE(line);
        const std::string text = std::string(line) + line + line;
        mentions(namedPoses("a.txt", text), "the camera counts as fixed: a.txt is not read");
        mentions(namedPoses("b.any.freiburg", "# header\n" + text), "b.any.freiburg is not read");
        mentions(namedPoses("c.csv", "time,x,y,z,a,b,c,d\n" + text), "c.csv is not read");
    }
}

TEST_CASE("A text of other numbers is not taken for poses") {
    for (const char* line :
         {"1 2 3 4 5 6 7 8\n", "0 0 1 1\n", "1.5 0.1 9.8 0.2\n", "1.5 depth/1.png 1.5 rgb/1.png\n",
          "7 0.1 0.2 0.3 0.4 0.5 0.6\n", "525 0 319.5 0 0 525 239.5 0 0 0 1 0\n", "a b c d e f g h\n",
          "0 0 0 0 0 0 0 0 0 0 0 0\n", ""}) {
        CAPTURE(line);
        CHECK(namedPoses("a.txt", std::string(line) + line + line) == "");
    }
    CHECK(namedPoses("intrinsic.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n") == ""); // of one camera
    CHECK(namedPoses("hand.csv", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n") == "");
    CHECK(namedPoses("press.csv", "t_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n") == "");
    for (const char* name :
         {"imu.txt", "imu0_data.csv", "IMUdata.txt", "gyro1.csv", "accel.txt", "object2.txt"}) {
        CAPTURE(name);
        CHECK(namedPoses(name, "1 0 0 0 1 0 0 0\n1 0 0 0 1 0 0 0\n1 0 0 0 1 0 0 0\n") == "");
    }
}

TEST_CASE("Poses in files and folders of other programs are named by their names") {
    for (const char* name :
         {"frames_pose.json", "cameras.json", "images.bin", "cam_poses.npy", "gt_trajectory.npz",
          "lowres_wide.traj", "sensor_poses.yaml", "gt_pose.log", "transforms_train.json", "odom.csv",
          "trajectory.mat", "camera_pose.csv", "CameraTrajectory.txt", "c2w.npy", "w2c.json", "cameras.npz",
          "cameras_sphere.npz", "cameras_linear_init.npz", "000012.pose"}) {
        CAPTURE(name);
        mentions(namedPoses(name, "x"), std::string(name) + " is not read");
    }
    for (const char* name : {"extrinsics", "cameras", "camera_poses", "camera_pose", "cam2world", "extrinsic",
                             "poses_gt", "camera_to_world", "odom", "trajectories", "w2c"}) {
        CAPTURE(name);
        mentions(namedPoses(std::string(name) + "/0.txt", "x"), std::string(name) + " is not read");
    }
    for (const char* name : {"object_poses.json", "hand_pose.csv", "human_pose/0.json", "composed.json",
                             "images.json", "cameras.txt", "joint_trajectory.csv", "purpose.txt",
                             "camera.npz", "camera_intrinsics.npz", "camera_calibration.npz"}) {
        CAPTURE(name);
        CHECK(namedPoses(name, "x") == "");
    }
}

TEST_CASE("Poses that lie one level below, or in sparse/0, are named with their folder") {
    const std::string log = "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    for (const char* name : {"scene/trajectory.log", "sparse/images.bin", "sparse/0/images.bin",
                             "colmap/sparse/0/images.bin", "results/CameraTrajectory.txt", "scene/a.log"}) {
        CAPTURE(name);
        mentions(namedPoses(name, log + log), std::string(name) + " is not read");
    }
    const TemporaryFolder folder;
    folder.write("sparse/0/cameras.txt", "1 PINHOLE 64 48 60 60 31.5 23.5\n");
    CHECK(unreadPoses(folder.path()) == "");
    folder.write("sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 0.png\n\n");
    mentions(unreadPoses(folder.path()), "sparse/0/images.txt is not read");
    folder.write("trajectory.log", log + log);
    mentions(unreadPoses(folder.path()), ": trajectory.log is not read");
    for (const char* name : {"objects/trajectory.log", "imu/a.log", "a/b/trajectory.log", ".git/traj.txt"}) {
        CAPTURE(name);
        CHECK(namedPoses(name, log + log) == "");
    }
    const TemporaryFolder other; // with a recording of its own in it
    other.write("day2/intrinsics.json", "{}");
    other.write("day2/poses.txt", "0 0 0 0 0 0 0 1\n");
    CHECK(unreadPoses(other.path()) == "");
}

TEST_CASE("Poses under a key of JSON are named, whatever the name of the file") {
    const std::string record3d =
        R"({"w": 64, "K": [60, 0, 0], "poses": [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0.1, 0, 0]]})";
    const std::string frames = R"({"frames": [{"file_path": "a.png", ")", matrix = R"(": [[1, 0, 0, 0]]}]})";
    for (const auto& file :
         {std::pair("metadata", record3d),
          {"metadata.json", record3d},
          {"capture/metadata", record3d},
          {"frame_00000.json", R"({"cameraPoseARFrame": [1, 0, 0, 0], "intrinsics": [60, 0, 31.5]})"},
          {"dataset.json", frames + "transform_matrix" + matrix},
          {"meta_data.json", frames + "camtoworld" + matrix}}) {
        CAPTURE(file.first);
        mentions(namedPoses(file.first, file.second), std::string(file.first) + " is not read");
    }
    const std::string deep(100'000, '[');
    for (const std::string& text :
         {std::string(R"({"poses": 3, "camera": [[1, 2]]})"), std::string(R"({"image": {"poses": [[1]]}})"),
          std::string(R"({"poses": [{"keypoints": [1]}]})"), std::string(R"(["transform_matrix", "poses"])"),
          std::string(R"({"cameraposeless)"), std::string(), "{\"a\": " + deep,
          std::string(17u << 20, ' ')}) {
        CHECK(namedPoses("metadata.json", text) == "");
    }
    CHECK(namedPoses("object.json", record3d) == "");
    CHECK(namedPoses("other", record3d) == "");
    CHECK(namedPoses("annotated_poses/0.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n") == ""); // of an object
}

TEST_CASE(
    "Motions of JSON that differ are named under any key, unless there are few or they are of an object") {
    const auto frames = [](const std::string& key, const std::string& before, const std::string& behind,
                           const std::vector<double>& xs) {
        std::string text = R"({"frames": [)";
        for (size_t i = 0; i < xs.size(); ++i) {
            text += std::string(i == 0 ? "" : ", ") + R"({"file": "0.png", "K": [60, 0, 31], ")" + key +
                    "\": " + before + std::to_string(xs[i]) + behind + "}";
        }
        return text + "]}";
    };
    const auto rows = [&](const std::string& key, const std::vector<double>& xs) {
        return frames(key, "[[1, 0, 0, ", "], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]", xs);
    };
    for (const char* key : {"pose", "T_wc", "extrinsic"}) {
        CAPTURE(key);
        mentions(namedPoses("meta.json", rows(key, {0.0, 0.1, 0.2})), "meta.json is not read");
        mentions(
            namedPoses("meta.json", frames(key, "[1, 0, 0, ", ", 0, 1, 0, 0, 0, 0, 1, 0]", {0.0, 0.1, 0.2})),
            "meta.json is not read");
        CHECK(namedPoses("meta.json", rows(key, {0.1, 0.1, 0.1})) == ""); // at rest
        CHECK(namedPoses("rig.json", rows(key, {0.0, 0.1})) == "");       // of two cameras
    }
    mentions(
        namedPoses("a.json", R"({"extrinsics": [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], [1, 0, 0, 1, 0, 1, 0, 0,
                                     0, 0, 1, 0], [1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0]]})"),
        "a.json is not read");
    mentions(namedPoses("a.json", R"([{"position": [0, 0, 0], "rotation": [0, 0, 0, 1]},
                                      {"position": [0, 0, 1], "rotation": [0, 0, 1, 0]},
                                      {"position": [0, 0, 2], "rotation": [1, 0, 0, 0]}])"),
             "a.json is not read");
    CHECK(namedPoses("meta.json", rows("object_pose", {0.0, 0.1, 0.2})) == "");
    CHECK(namedPoses("annotations.json", rows("box_pose", {0.0, 0.1, 0.2})) == "");
    CHECK(namedPoses("scene.json", R"({"assets": )" + rows("matrix", {0.0, 0.1, 0.2}) + "}") == "");
    CHECK(namedPoses("calib.json", rows("T", {0.0, 0.1, 0.2})) == ""); // of three cameras
    CHECK(namedPoses("rig.json", rows("T", {0.0, 0.1, 0.2}), 8) == "");
    mentions(namedPoses("rig.json", rows("T", {0.0, 0.1, 0.2}), 6), "rig.json is not read");
    CHECK(namedPoses("meta.json", R"({"objects": )" + rows("pose", {0.0, 0.1, 0.2}) + "}") == "");
    CHECK(namedPoses("meta.json", frames("K_4", "[[600, 0, 320, ", "], [0, 600, 240, 0], [0, 0, 1, 0]]",
                                         {0.0, 0.1, 0.2})) == "");
}

TEST_CASE("A bag whose tf moves depth's frame has a warning that names the link that moves") {
    BagMaker maker = registeredImages();
    addLink(maker, "/tf_static", 1.0, "camera", "optical", 0.02);
    for (int i = 0; i < 4; ++i) {
        addLink(maker, "/tf", 1.0 + 0.1 * i, "world", "camera", 0.05 * i);
        addLink(maker, "/tf", 1.0 + 0.1 * i, "world", "arm", 0.07 * i);
    }
    const std::string lines = fixedWarnings(maker);
    mentions(lines, "the camera counts as fixed, but /tf moves 'camera' in 'world'");
    CHECK(std::ranges::count(lines, '\n') == 1);
}

TEST_CASE("A bag whose camera starts to move late in a long tf has the warning, too") {
    BagMaker maker = registeredImages();
    for (int i = 0; i < 3000; ++i) {
        addLink(maker, "/tf", 1.0 + 0.0001 * i, "world", "camera", i < 2500 ? 0.0 : 0.0001 * (i - 2500));
        addLink(maker, "/tf", 1.0 + 0.0001 * i, "base", "wheel", 0.001 * i);
        addLink(maker, "/tf", 1.0 + 0.0001 * i, "camera", "optical", 0.0);
    }
    mentions(fixedWarnings(maker), "/tf moves 'camera' in 'world'");
}

TEST_CASE("A bag whose camera does not move in tf has no warning") {
    BagMaker still = registeredImages();
    addLink(still, "/tf_static", 1.0, "camera", "optical", 0.02);
    for (int i = 0; i < 4; ++i) {
        addLink(still, "/tf", 1.0 + 0.1 * i, "world", "camera", 0.0002 * (i % 2)); // jitter
        addLink(still, "/tf", 1.0 + 0.1 * i, "world", "arm", 0.07 * i);
        addLink(still, "/tf", 1.0 + 0.1 * i, "optical", "marker", 0.07 * i);
    }
    CHECK(fixedWarnings(still) == "");
    CHECK(fixedWarnings(registeredImages()) == "");
}

TEST_CASE("A bag with a topic of poses that move has a warning that names it, unless a tool's or a goal's") {
    const auto warned = [](const std::string& topic, const std::string& type, double step) {
        BagMaker maker = registeredImages();
        for (int i = 0; i < 4; ++i) {
            addPose(maker, topic, type, 1.0 + 0.1 * i, step * i);
        }
        return fixedWarnings(maker);
    };
    for (const char* type : {"geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped",
                             "geometry_msgs/TransformStamped", "nav_msgs/Odometry"}) {
        CAPTURE(type);
        mentions(warned("/vicon/camera", type, 0.05),
                 "the camera counts as fixed: if the poses of /vicon/camera are its own, they are not read");
        CHECK(warned("/vicon/camera", type, 0.0) == "");
        for (const char* other : {"/fathom/tool_pose", "/goal_pose", "/object/pose", "/ee_pose"}) {
            CHECK(warned(other, type, 0.05) == "");
        }
    }
}
