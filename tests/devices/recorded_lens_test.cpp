// SPDX-License-Identifier: Apache-2.0
// Files of lenses as other programs write them, and images without one.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/played_bag.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string lensRefusal(const std::string& lens) {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "rgb/0.png", 500);
    folder.write("lens.yaml", lens);
    return recordingRefusal(folder.path(), {.intrinsics = folder.path() / "lens.yaml"});
}

} // namespace

TEST_CASE(
    "A lens file in YAML is refused as not JSON, with its first line and where the fields are documented") {
    mentions(lensRefusal("\nimage_width: 640\nimage_height: 480\n"),
             "lens.yaml: syntax: not JSON, begins with image_width: 640 (allowed: JSON with the fields of "
             "docs/guide/recordings.md; YAML calibrations are not read)");
    mentions(lensRefusal("%YAML:1.0\n---\n"), "not JSON, begins with %YAML:1.0 (allowed");
    mentions(lensRefusal("# Camera list"), "not JSON, begins with # Camera list (allowed");
    mentions(lensRefusal(R"({"width": 7,,})"), "(allowed: JSON (which has no NaN or infinity))");
}

TEST_CASE("A field of a lens under the name of another program is refused with the name that is read") {
    const std::string size = R"({"width": 7, "height": 5, )", focal = R"("fx": 6, "fy": 6, )";
    mentions(lensRefusal(size + focal + R"("ppx": 3, "ppy": 2})"), "ppx: 3 (allowed: the name cx)");
    mentions(lensRefusal(size + focal + R"("cx": 3, "ppy": 2})"), "ppy: 2 (allowed: the name cy)");
    mentions(lensRefusal(R"({"w": 7, "h": 5, "fl_x": 6, "fl_y": 6, "cx": 3, "cy": 2})"),
             "w: 7 (allowed: the name width)");
    mentions(
        lensRefusal(R"({"camera": {"w": 7, "h": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2, "scale": 6553.5}})"),
        "(allowed: width, height, fx, fy, cx and cy at the top level of the file)");
    mentions(lensRefusal(R"({"width": 7, "image_height": 5})"), "image_height: 5 (allowed: the name height)");
    mentions(lensRefusal(size + R"("fl_x": 6, "fl_y": 6, "cx": 3, "cy": 2})"),
             "fl_x: 6 (allowed: the name fx)");
    mentions(lensRefusal(size + R"("K": [6, 0, 3, 0, 6, 2, 0, 0, 1]})"),
             "(allowed: fx, fy, cx and cy, each under");
}

TEST_CASE("Images without a lens file are refused with the option that names one, and play with it") {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "rgb/0.png", 500);
    mentions(recordingRefusal(folder.path()), "/intrinsics.json: file: missing (allowed: ");
    folder.write("K.txt", "6 0 3\n0 6 2\n0 0 1\n");
    folder.write("objects_pose.json", "{}");
    mentions(recordingRefusal(folder.path()),
             "/intrinsics.json: file: missing; K.txt is there, which is not read by itself (allowed: ");
    mentions(recordingRefusal(folder.path()),
             "or intrinsics=FILE after the folder name (its images pair by "
             "an index, or by number in depth/ and rgb/, color/, image/ or images/)");
    folder.write("lens.json", kSmallIntrinsics);
    CHECK(playedDepths(folder.path(), {.intrinsics = folder.path() / "lens.json"}) ==
          std::vector<uint16_t>{500});
}

TEST_CASE(
    "Images without an index pair by number with a given lens, also with that of their intrinsics.json") {
    const TemporaryFolder folder;
    addPair(folder, "depth/000000.png", "color/000000.png", 500);
    addPair(folder, "depth/000001.png", "color/000001.png", 600);
    folder.write("intrinsics.json", kSmallIntrinsics);
    mentions(recordingRefusal(folder.path()), "or intrinsics=FILE after the folder name, also its own "
                                              "intrinsics.json, which pairs images by number");
    std::string fifths = kSmallIntrinsics;
    folder.write("intrinsics.json", fifths.replace(fifths.find("0.001"), 5, "0.0002"));
    const std::filesystem::path own = folder.path() / "intrinsics.json", other = folder.path() / "lens.json";
    CHECK(playedDepths(folder.path(), {.intrinsics = own}) == std::vector<uint16_t>{500, 600});
    folder.write("lens.json", R"({"width": 7, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2})");
    CHECK(playedDepths(folder.path(), {.intrinsics = other}) == std::vector<uint16_t>{500, 600});
    const RecordedCamera camera(folder.path(), {.intrinsics = other});
    CHECK(camera.info().depth.fx == 6.0);
    CHECK(camera.info().metresPerUnit == doctest::Approx(0.0002)); // that of intrinsics.json
    std::string stamped = kSmallIntrinsics; // its stamps are the index, whatever lens is given
    folder.write(
        "intrinsics.json",
        stamped.insert(stamped.find('{') + 1, R"("depth_stamps_s": [0, 0.1], "color_stamps_s": [0, 0.1], )"));
    mentions(recordingRefusal(folder.path(), {.intrinsics = other}), "associations.txt: missing");
}

TEST_CASE("Files of lenses of COLMAP, Kalibr and Record3D are named where no lens is read") {
    for (const char* name : {"sparse/0/cameras.txt", "sparse/0/cameras.bin", "camchain.yaml", "metadata",
                             "calibration/camchain-imucam.yaml"}) {
        const TemporaryFolder folder;
        addPair(folder, "depth/0.png", "rgb/0.png", 500);
        folder.write(name, "{}");
        mentions(recordingRefusal(folder.path()),
                 "missing; " + std::string(name) + " is there, which is not read by itself");
    }
}

TEST_CASE("Folders of Nerfstudio are refused with the name of their lens file, and play with a lens") {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "images/0.png", 500);
    folder.write("transforms.json", R"({"w": 7, "h": 5, "fl_x": 6, "fl_y": 6, "cx": 3, "cy": 2})");
    mentions(recordingRefusal(folder.path()),
             "missing; transforms.json is there, which is not read by itself");
    folder.write("mine.json", kSmallIntrinsics);
    CHECK(playedDepths(folder.path(), {.intrinsics = folder.path() / "mine.json"}) ==
          std::vector<uint16_t>{500});
}

TEST_CASE(
    "A folder of FoundationPose plays with the lens of cam_K.txt in millimetres, unless it has an index") {
    const TemporaryFolder folder;
    addPair(folder, "depth/1581120424100262102.png", "rgb/1581120424100262102.png", 501);
    folder.write("cam_K.txt", "6.0e+00 0 3.0e+00\n0 6.5 2\n0 0 1\n");
    RecordedCamera camera(folder.path());
    CHECK(camera.info().depth.fx == 6.0);
    CHECK(camera.info().depth.fy == 6.5);
    CHECK(camera.info().registered);
    CHECK(camera.info().metresPerUnit == 0.001);
    CHECK(camera.warnings().empty());
    CHECK(camera.next().value()->depth[0] == 501);
    folder.write("mine.json", kSmallIntrinsics);
    RecordedCamera other(folder.path(), {.intrinsics = folder.path() / "mine.json"});
    CHECK(other.info().depth.fy == 6.25);
    folder.write("associations.txt", "");
    mentions(recordingRefusal(folder.path()), "missing; cam_K.txt is there, which is not read by itself");
    std::filesystem::remove(folder.path() / "associations.txt");
    std::filesystem::remove_all(folder.path() / "rgb");
    mentions(recordingRefusal(folder.path()),
             "colour images: none (allowed: a folder color, rgb, image or images");
    CHECK(playedDepths(folder.path(), {.colour = "none"}) == std::vector<uint16_t>{501});
}

TEST_CASE("A range along a pixel's ray is played as the depth along the optical axis, which is smaller") {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "rgb/0.png", 2000);
    std::string lens = kSmallIntrinsics;
    folder.write("camera_intrinsic.json", lens.insert(lens.find('{') + 1, R"("depth_is": "range", )"));
    RecordedCamera camera(folder.path());
    const glm::dvec2 ray = camera.info().depth.ray(0, 0);
    const double slant = std::sqrt(1.0 + glm::dot(ray, ray));
    REQUIRE(slant > 1.01);
    CHECK(camera.next().value()->depth[0] == std::lround(2000.0 / slant));
}

TEST_CASE("Images that are named as ranges, but played as z, have a warning that names depth_is") {
    const auto warned = [](const std::string& depth, const std::string& kind) {
        const TemporaryFolder folder;
        addPair(folder, "depth/" + depth + ".png", "rgb/0.png", 500);
        std::string lens = kSmallIntrinsics;
        folder.write("camera_intrinsic.json", lens.insert(lens.find('{') + 1, kind));
        const testing::Listening log;
        CHECK(playedDepths(folder.path()).size() == 1);
        return log.count("\"depth_is\": \"range\" in the file of the lens");
    };
    CHECK(warned("distance_to_camera_0", "") == 1);
    CHECK(warned("DepthPerspective_0", "") == 1);
    CHECK(warned("distance_to_camera_0", R"("depth_is": "range", )") == 0);
    CHECK(warned("distance_to_image_plane_0", "") == 0);
}

TEST_CASE("Depth images with numbers play with a lens alone where there is no folder of colour") {
    const TemporaryFolder folder;
    writeDepth(folder.path() / "depth/000000.png", kSmallWidth, kSmallHeight, 500);
    folder.write("rgb.mp4", "x");
    folder.write("lens.json", kSmallIntrinsics);
    const std::filesystem::path lens = folder.path() / "lens.json";
    CHECK(playedDepths(folder.path(), {.colour = "none", .intrinsics = lens}) == std::vector<uint16_t>{500});
    mentions(recordingRefusal(folder.path(), {.intrinsics = lens}), "or colour=none after the folder name");
    std::string depthOnly = kSmallIntrinsics;
    folder.write("lens.json", depthOnly.insert(depthOnly.find('{') + 1, R"("has_color": false, )"));
    CHECK(playedDepths(folder.path(), {.intrinsics = lens}) == std::vector<uint16_t>{500});
}

TEST_CASE("A lens of another size of image has a warning in the recording of a folder") {
    const auto warned = [](const std::string& part, const std::string& with) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        std::string lens = kSmallIntrinsics;
        folder.write("intrinsics.json", lens.replace(lens.find(part), part.size(), with));
        const auto warnings = RecordedCamera(folder.path()).warnings();
        return warnings.empty() ? "" : warnings[0];
    };
    CHECK(warned("7", "7") == "");
    mentions(warned("\"cx\": 3", "\"cx\": 319.5"),
             "the lens of depth has fx 6.5, fy 6.2 and the principal point (319.5, 2.0) in images of 7x5: it "
             "may be that of another image size");
    mentions(warned("\"cy\": 2", "\"cy\": -2"), "(3.0, -2.0)");
    mentions(warned("\"fx\": 6.5", "\"fx\": 65"), "fx 65.0");
    CHECK(warned("\"width\": 7", R"("projection": "equal_angles", "width": 7)") == "");
}

TEST_CASE("A lens matrix whose principal point is that of smaller images has a warning with its file") {
    const auto warnings = [](const std::string& file, const std::string& text, const std::string& depth,
                             const std::string& colour) {
        const TemporaryFolder folder;
        folder.write(file, text);
        std::filesystem::create_directories((folder.path() / depth).parent_path());
        std::filesystem::create_directories((folder.path() / colour).parent_path());
        writeDepth(folder.path() / depth, 64, 48, 500);
        writeColour(folder.path() / colour, 64, 48, 1, 2, 3);
        folder.write("intrinsic/intrinsic_color.txt", "30 0 31.5\n0 30 23.5\n0 0 1\n");
        return RecordedCamera(folder.path()).warnings();
    };
    const auto warned = [&](const std::string& cx, const std::string& cy) {
        const std::string matrix = "30 0 " + cx + "\n0 30 " + cy + "\n0 0 1\n";
        std::string all;
        for (const auto& of :
             {warnings("camera-intrinsics.txt", matrix, "frame-000000.depth.png", "frame-000000.color.png"),
              warnings("intrinsic/intrinsic_depth.txt", matrix, "depth/0.png", "color/0.png"),
              warnings("scene_camera.json",
                       R"({"0": {"depth_scale": 1, "cam_K": [30, 0, )" + cx + ", 0, 30, " + cy +
                           ", 0, 0, 1]}}",
                       "depth/0.png", "rgb/0.png")}) {
            all += of.empty() ? "" : of.at(0) + "\n";
        }
        return all;
    };
    for (const auto& point : {std::pair("16", "12"), {"15.5", "11.5"}, {"10.7", "8"}, {"15.7", "12.2"}}) {
        CAPTURE(point.first);
        const std::string all = warned(point.first, point.second);
        for (const char* matrix :
             {"camera-intrinsics.txt", "intrinsic_depth.txt", "scene_camera.json: cam_K"}) {
            mentions(all, std::string(matrix) + ": the principal point (" + point.first);
        }
        mentions(all, " % of the width and the height of images of 64x48: it may be the lens of another");
    }
    // In the middle, and of crops.
    for (const auto& point :
         {std::pair("31.5", "23.5"), {"32", "24"}, {"29", "25"}, {"16", "23"}, {"20", "12"}, {"45", "26"}}) {
        CAPTURE(point.first);
        CHECK(warned(point.first, point.second) == "");
    }
}

TEST_CASE("The skew of a lens matrix of a folder has a warning with the matrix and its pixels") {
    const auto warnings = [](const std::string& file, const std::string& text, const std::string& depth,
                             const std::string& colour) {
        const TemporaryFolder folder;
        addPair(folder, depth, colour, 500);
        folder.write(file, text);
        folder.write("intrinsic/intrinsic_color.txt", "6 0 3\n0 6 2\n0 0 1\n");
        return RecordedCamera(folder.path()).warnings();
    };
    const auto warned = [&](const std::string& skew) {
        const std::string matrix = "6 " + skew + " 3\n0 6 2\n0 0 1\n", frame = "frame-000000.";
        const std::string depth = frame + "depth.png", colour = frame + "color.png";
        const std::string sizes = "m_colorWidth = 7\nm_colorHeight = 5\nm_depthWidth = 7\nm_depthHeight = 5\n"
                                  "m_depthShift = 1000\n";
        const std::string rest = " 3 0 0 6 2 0 0 0 1 0 0 0 0 1\n";
        std::string all;
        for (const auto& of :
             {warnings("camera-intrinsics.txt", matrix, depth, colour),
              warnings("info.txt",
                       sizes + "m_calibrationDepthIntrinsic = 6 " + skew + rest +
                           "m_calibrationColorIntrinsic = 6 0" + rest,
                       depth, colour),
              warnings("intrinsic/intrinsic_depth.txt", matrix, "depth/0.png", "color/0.png"),
              warnings("scene_camera.json",
                       R"({"0": {"depth_scale": 1, "cam_K": [6, )" + skew + ", 3, 0, 6, 2, 0, 0, 1]}}",
                       "depth/0.png", "rgb/0.png"),
              warnings("camera_intrinsic.json",
                       R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, )" + skew +
                           ", 6, 0, 3, 2, 1]}",
                       "depth/0.png", "color/0.png"),
              warnings("intrinsic.json",
                       R"({"width": 7, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2, "skew": )" + skew +
                           "}",
                       "depth/0.png", "color/0.png")}) {
            all += of.empty() ? "" : of.at(0) + "\n";
        }
        return all;
    };
    CHECK(warned("0.05") == "");
    const std::string all = warned("-0.6"),
                      rest = ": a skew of -0.6 pixels is not used: the images are played without it\n";
    for (const char* matrix :
         {"camera-intrinsics.txt", "info.txt: m_calibrationDepthIntrinsic", "intrinsic_depth.txt",
          "scene_camera.json: cam_K", "camera_intrinsic.json: intrinsic_matrix", "intrinsic.json: skew"}) {
        mentions(all, matrix + rest);
    }
}

TEST_CASE("A lens of another size of image has a warning in a bag") {
    const auto warned = [](const std::array<double, 4>& k) {
        const TemporaryFolder folder;
        BagMaker maker;
        addStream(maker, "/camera/depth/image_raw", depthImage(500), {.k = k});
        return playStreams(folder, maker).warnings();
    };
    CHECK(warned({7.0, 7.0, 3.5, 2.5}).empty());
    const auto warnings = warned({52.5, 52.5, 31.9, 23.9});
    REQUIRE(warnings.size() == 1);
    mentions(warnings[0], "the lens of depth has fx 52.5, fy 52.5 and the principal point (31.9, 23.9)");
}
