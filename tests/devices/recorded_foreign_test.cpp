// SPDX-License-Identifier: Apache-2.0
// Folders as other programs and systems leave them: damaged first images, other names, files of archives.
#include "devices/recorded/recorded_camera.h"
#include "devices/recorded/unread_poses.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Three pairs of 7 x 5 images: depth 500, 501 and 502.
void addThreePairs(const TemporaryFolder& folder, const std::string& colour) {
    for (uint16_t i = 0; i < 3; ++i) {
        const std::string number = std::to_string(i) + ".png";
        addPair(folder, "depth/" + number, colour + "/" + number, static_cast<uint16_t>(500 + i));
    }
}

const std::string kOpen3dLens =
    R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6.5, 0, 3, 2, 1]})";

using Depths = std::vector<uint16_t>;

const std::string kSensorInfo = "m_versionNumber = 4\nm_sensorName = Structure Sensor\n"
                                "m_colorWidth = 14\nm_colorHeight = 10\nm_depthWidth = 7\nm_depthHeight = 5\n"
                                "m_depthShift = 5000\n"
                                "m_calibrationColorIntrinsic = 12 0 6 0 0 13 5 0 0 0 1 0 0 0 0 1 \n"
                                "m_calibrationColorExtrinsic = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 \n"
                                "m_calibrationDepthIntrinsic = 6 0 3 0 0 6.5 2 0 0 0 1 0 0 0 0 1 \n"
                                "m_calibrationDepthExtrinsic = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 \n"
                                "m_frames.size = 2\n";

// Two frames in the size of kSensorInfo, from the given number.
void addFrames(const TemporaryFolder& folder, int first, const std::string& inside = "") {
    std::filesystem::create_directories(folder.path() / inside);
    for (int i = first; i < first + 2; ++i) {
        const std::string stem = inside + "frame-00000" + std::to_string(i);
        writeDepth(folder.path() / (stem + ".depth.png"), kSmallWidth, kSmallHeight,
                   i == first ? 500 : 65535);
        writeColour(folder.path() / (stem + ".color.png"), 14, 10, 1, 2, 3);
        folder.write(stem + ".pose.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    }
}

} // namespace

TEST_CASE("A damaged first image loses its own frame where a layout takes sizes from the images") {
    const TemporaryFolder scanNet, bop;
    addThreePairs(scanNet, "color");
    std::filesystem::create_directories(scanNet.path() / "intrinsic");
    scanNet.write("intrinsic/intrinsic_depth.txt", "7 0 3 0\n0 7 2 0\n0 0 1 0\n0 0 0 1\n");
    scanNet.write("intrinsic/intrinsic_color.txt", "7 0 3 0\n0 7 2 0\n0 0 1 0\n0 0 0 1\n");
    addThreePairs(bop, "rgb");
    const std::string image = R"({"cam_K": [7, 0, 3, 0, 7, 2, 0, 0, 1], "depth_scale": 1.0})";
    bop.write("scene_camera.json", R"({"0": )" + image + R"(, "1": )" + image + R"(, "2": )" + image + "}");
    for (const TemporaryFolder* folder : {&scanNet, &bop}) {
        CHECK(playedDepths(folder->path()) == Depths{500, 501, 502});
        folder->write("depth/0.png", "");
        CHECK(playedDepths(folder->path()) == Depths{501, 502});
        folder->write(folder == &bop ? "rgb/1.png" : "color/1.png", "");
        CHECK(playedDepths(folder->path()) == Depths{502});
        folder->write("depth/1.png", "");
        folder->write("depth/2.png", "");
        mentions(recordingRefusal(folder->path()), "depth/0.png: image: ");
    }
}

TEST_CASE("Hidden files that an archive left beside images and messages are no part of a recording") {
    const TemporaryFolder open3d, stamped;
    addThreePairs(open3d, "color");
    open3d.write("camera_intrinsic.json", kOpen3dLens);
    open3d.write("depth/._0.png", "x");
    open3d.write("color/._0.png", "x");
    CHECK(playedDepths(open3d.path()) == Depths{500, 501, 502});
    addThreePairs(stamped, "rgb");
    stamped.write("rgb/._0.png", "x");
    std::string lens = kSmallIntrinsics;
    lens.insert(lens.find('{') + 1, R"("depth_stamps_s": [1, 2, 3], "color_stamps_s": [1, 2, 3], )");
    stamped.write("intrinsics.json", lens);
    CHECK(playedDepths(stamped.path()) == Depths{500, 501, 502});
}

TEST_CASE(
    "Open3D's names of the lens file and of the folder of colour are all read, and a lens alone is enough") {
    for (const char* lens : {"camera_intrinsic.json", "intrinsic.json", "camera_primesense.json"}) {
        for (const char* colour : {"color", "rgb", "image"}) {
            const TemporaryFolder folder;
            addThreePairs(folder, colour);
            folder.write(lens, kOpen3dLens);
            CHECK(playedDepths(folder.path()) == Depths{500, 501, 502});
            CHECK(RecordedCamera(folder.path()).info().depth.fy == 6.5);
            std::filesystem::rename(folder.path() / lens, folder.path() / "my_lens.json");
            mentions(recordingRefusal(folder.path()), "intrinsics.json: file: missing");
            const SourceOptions alone{.intrinsics = folder.path() / "my_lens.json"};
            CHECK(playedDepths(folder.path(), alone) == Depths{500, 501, 502});
        }
    }
    const TemporaryFolder bare;
    writeDepth(bare.path() / "depth/0.png", kSmallWidth, kSmallHeight, 500);
    bare.write("intrinsic.json", kOpen3dLens);
    mentions(recordingRefusal(bare.path()),
             "colour images: none (allowed: a folder color, rgb, image or images");
    CHECK(playedDepths(bare.path(), {.colour = "none"}) == Depths{500});
}

TEST_CASE("A lens of another size than colour is named with its file") {
    const TemporaryFolder folder;
    addThreePairs(folder, "color");
    folder.write("camera_intrinsic.json", kOpen3dLens);
    for (const char* name : {"color/0.png", "color/1.png", "color/2.png"}) {
        writeColour(folder.path() / name, 14, 10, 1, 2, 3);
    }
    mentions(recordingRefusal(folder.path()), ": camera_intrinsic.json: color.width, color.height: ");
}

TEST_CASE("Images frame-N with a file of calibration have its lenses and unit, not those of 7-Scenes") {
    for (const char* name : {"info.txt", "_info.txt"}) {
        const TemporaryFolder folder;
        addFrames(folder, 0);
        folder.write(name, kSensorInfo);
        RecordedCamera camera(folder.path());
        CHECK(camera.info().depth.fx == 6.0);
        CHECK(camera.info().depth.fy == 6.5);
        CHECK(camera.info().colour.cx == 6.0);
        CHECK(camera.info().colour.fy == 13.0);
        CHECK_FALSE(camera.info().registered);
        CHECK(camera.info().metresPerUnit == doctest::Approx(0.0002));
        CHECK_FALSE(camera.info().poseless);
        CHECK(playedDepths(folder.path()) == Depths{500, 65535});
        folder.write("lens.json", R"({"width": 7, "height": 5, "fx": 9, "fy": 9, "cx": 3, "cy": 2})");
        const SourceOptions lens{.colour = "none", .intrinsics = folder.path() / "lens.json"};
        CHECK(RecordedCamera(folder.path(), lens).info().depth.fx == 9.0);
        CHECK(RecordedCamera(folder.path(), lens).info().metresPerUnit == doctest::Approx(0.0002));
    }
}

TEST_CASE("Images frame-N have the calibration beside their folder, as in 12-Scenes, however it is named") {
    const TemporaryFolder scene;
    addFrames(scene, 0, "data/");
    mentions(recordingRefusal(scene.path() / "data"),
             "of the size of this layout's usual lens; or intrinsics=FILE");
    scene.write("info.txt", kSensorInfo);
    for (const char* name : {"data", "data/", "./data"}) {
        CHECK(RecordedCamera(scene.path() / name).info().depth.fx == 6.0);
    }
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(scene.path() / "data");
    CHECK(RecordedCamera(".").info().depth.fx == 6.0);
    std::filesystem::current_path(before);
}

TEST_CASE("Other content named info.txt next to a folder of images frame-N is no reason to refuse it") {
    const auto addSequence = [](const TemporaryFolder& scene) {
        std::filesystem::create_directories(scene.path() / "seq");
        writeDepth(scene.path() / "seq/frame-000000.depth.png", 640, 480, 500);
        scene.write("lens.json", R"({"width": 640, "height": 480, "fx": 9, "fy": 9, "cx": 3, "cy": 2})");
        const SourceOptions lens{.colour = "none", .intrinsics = scene.path() / "lens.json"};
        CHECK(RecordedCamera(scene.path() / "seq", {.colour = "none"}).info().depth.fx == 585.0);
        CHECK(RecordedCamera(scene.path() / "seq", lens).info().depth.fx == 9.0);
    };
    for (const std::string& text : {std::string(2400, 'a'), std::string("a\0b", 3), std::string("= = =")}) {
        const TemporaryFolder scene;
        scene.write("info.txt", text);
        addSequence(scene);
    }
    const TemporaryFolder scene;
    std::filesystem::create_directories(scene.path() / "info.txt");
    addSequence(scene);
}

TEST_CASE("A calibration of images frame-N that cannot be used is named by its key") {
    const TemporaryFolder folder;
    addFrames(folder, 0);
    const auto refused = [&](const std::string& part, const std::string& with) {
        std::string text = kSensorInfo;
        folder.write("info.txt", text.replace(text.find(part), part.size(), with));
        return recordingRefusal(folder.path());
    };
    mentions(refused("m_depthShift = 5000", ""), "info.txt: m_depthShift: missing (allowed: 1 number)");
    mentions(refused("5000", "0.001"), "m_depthShift: 0.001 (allowed: units per metre");
    mentions(refused("6 0 3 0 0 6.5", "0 0 3 0 0 6.5"), "m_calibrationDepthIntrinsic: 0 0 3");
    mentions(refused("12 0 6", "x 0 6"), "m_calibrationColorIntrinsic: x 0 6");
    mentions(refused("Extrinsic = 1", "Extrinsic = 0.9"), "m_calibrationColorExtrinsic: 0.9");
    mentions(refused("m_depthWidth = 7", "m_depthWidth = 7000"),
             "m_depthWidth: 7000 (allowed: a whole number");
    mentions(refused("m_depthWidth = 7", "m_depthWidth = 8"), "frames: none");
}

TEST_CASE("Part of a sequence of images frame-N plays, whatever its first number is") {
    const TemporaryFolder folder;
    addFrames(folder, 5);
    folder.write("info.txt", kSensorInfo);
    CHECK(playedDepths(folder.path()) == Depths{500, 65535});
    CHECK(RecordedCamera(folder.path()).info().depth.fx == 6.0);
}

TEST_CASE(
    "Images, index and lens that are pointers of Git LFS are named as such, and one loses its own frame") {
    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
    for (const char* name : {"intrinsics.json", "associations.txt", "depth/0.png", "rgb/0.png"}) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        folder.write(name, pointer);
        CAPTURE(name);
        mentions(recordingRefusal(folder.path()), name);
        mentions(recordingRefusal(folder.path()), "Git LFS pointer");
    }
    const TemporaryFolder folder;
    addThreePairs(folder, "color");
    folder.write("camera_intrinsic.json", kOpen3dLens);
    folder.write("depth/0.png", pointer);
    folder.write("color/2.png", pointer);
    CHECK(playedDepths(folder.path()) == Depths{501});
}

TEST_CASE("Colour in a format that is not read is named as such") {
    const std::string bmp = std::string("BM") + std::string(60, '\0'), webp = "RIFF1234WEBPVP8 ";
    for (const auto& [text, fault] : {std::pair(bmp, "not PNG or JPEG"),
                                      {webp, "not PNG or JPEG"},
                                      {"P6\n7 5\n255\n", "not PNG or JPEG"},
                                      {"", "an empty file"},
                                      {"\x89PNG\r\n\x1a\nx", "libpng: "}}) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        folder.write("rgb/0.png", text);
        mentions(recordingRefusal(folder.path()), "rgb/0.png: " + std::string(fault));
    }
}

TEST_CASE(
    "A lens and an index in the words of other programs are refused by name, with the words that are read") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    const auto refused = [&](const std::string& part, const std::string& with) {
        std::string text = kSmallIntrinsics;
        folder.write("intrinsics.json", text.replace(text.find(part), part.size(), with));
        return recordingRefusal(folder.path());
    };
    mentions(refused(R"("fy": 6.25)", R"("fy": -6.25)"), // as ICL-NUIM publishes it
             "fy: -6.25 (allowed: a number above 0; y points down here: give a negative fy without its sign; "
             "where y points up in the world, too, as at ICL-NUIM, negate ty, qx and qz of poses.txt)");
    mentions(refused(R"("fx": 6.5)", R"("K": [6.5, 0, 3, 0, 6.25, 2, 0, 0, 1])"),
             "K: [6.5,0,3,0,6.25,2,0,0,1] (allowed: fx, fy, cx and cy, each under its name");
    mentions(refused(R"("fx": 6.5)", R"("camera_matrix": {"data": []})"),
             "camera_matrix: an object (allowed: fx");
    mentions(refused(R"("fx": 6.5,)", ""), "fx: missing");
    folder.write("intrinsics.json", kSmallIntrinsics);
    std::filesystem::rename(folder / "associations.txt", folder / "associate.txt");
    mentions(recordingRefusal(folder.path()), "associations.txt: missing; associate.txt is there (allowed: ");
}

TEST_CASE("A folder around a recording is refused with the recording's name, up to two levels below") {
    const TemporaryFolder folder;
    const auto names = [&](const std::string& inner) {
        mentions(recordingRefusal(folder.path()),
                 "no recording itself (allowed: one inside of it: " + (folder.path() / inner).string() + ")");
    };
    folder.write("readme.txt", "unpacked");
    folder.write(".hidden/intrinsics.json", "{}");
    folder.write("z/b/c/intrinsics.json", "{}"); // too deep
    mentions(recordingRefusal(folder.path()), "intrinsics.json: file: missing");
    folder.write("test/000001/scene_camera.json", "{}");
    names("test/000001");
    folder.write("m/a.bag", "");
    names("m/a.bag");
    folder.write("inner/intrinsics.json", "{}");
    names("inner");
}

TEST_CASE("Poses in a file that is not read are named, and those that are read are not") {
    for (const auto& [name, advice] : {std::pair("groundtruth.txt", "copy it to poses.txt"),
                                       {"trajectory.log", "needs poses.txt next to"},
                                       {"transforms.json", "needs poses.txt"},
                                       {"pose/0.txt", "pose is not read"},
                                       {"Camera_Poses.csv", "Camera_Poses.csv is not read"}}) {
        const TemporaryFolder folder;
        folder.write("objects.txt", "");
        CHECK(unreadPoses(folder.path()) == "");
        folder.write(name, "");
        mentions(unreadPoses(folder.path()), advice);
        mentions(unreadPoses(folder.path()), "the camera counts as fixed");
    }
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    folder.write("groundtruth.txt", "0 0 0 0 0 0 0 1\n");
    const testing::Listening log;
    RecordedCamera(folder.path()).next();
    CHECK(log.count("groundtruth.txt is not read") == 1);
    folder.write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
    RecordedCamera(folder.path()).next();
    CHECK(log.count("is not read") == 1);
}
