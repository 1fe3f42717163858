// SPDX-License-Identifier: Apache-2.0
// Images frame-N: which calibration they have, and which poses.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

namespace fs = std::filesystem;

constexpr const char* kRestOfMatrix = " 0 320 0 0 572 240 0 0 0 1 0 0 0 0 1\n";
const std::string kFrameInfo = "m_depthWidth = 640\nm_depthHeight = 480\nm_depthShift = 1000\n"
                               "m_calibrationDepthIntrinsic = 572" +
                               std::string(kRestOfMatrix);
const SourceOptions kFramesOnly{.colour = "none"};

void addFrame(const fs::path& folder, const std::string& kind = "depth") {
    fs::create_directories(folder);
    writeDepth(folder / ("frame-000000." + kind + ".png"), 640, 480, 500);
}

// Each character as two bytes, as some editors of Windows save text.
std::string asUtf16(const std::string& text) {
    std::string wide = "\xff\xfe";
    for (const char c : text) {
        wide += c;
        wide += '\0';
    }
    return wide;
}

// The line of its warnings that names the lens of 7-Scenes; empty = none.
std::string nominalWarning(const fs::path& folder) {
    for (const std::string& warning : RecordedCamera(folder, kFramesOnly).warnings()) {
        if (warning.find("nominal lens of 7-Scenes") != std::string::npos) {
            return warning;
        }
    }
    return "";
}

} // namespace

TEST_CASE("Images frame-N behind a link have the calibration next to the link or its target") {
    const TemporaryFolder disk, scene;
    addFrame(disk.path() / "images");
    scene.write("info.txt", kFrameInfo);
    fs::create_directory_symlink(disk.path() / "images", scene.path() / "data");
    for (const char* name : {"data", "data/"}) {
        CHECK(RecordedCamera(scene.path() / name, kFramesOnly).info().depth.fx == 572.0);
    }
    fs::rename(scene.path() / "info.txt", disk.path() / "info.txt");
    CHECK(RecordedCamera(scene.path() / "data", kFramesOnly).info().depth.fx == 572.0);
}

TEST_CASE(
    "Images frame-N without a calibration have a warning that the lens is the nominal one of 7-Scenes") {
    const TemporaryFolder scene;
    addFrame(scene.path() / "data");
    mentions(nominalWarning(scene.path() / "data"), "info.txt or intrinsics=FILE");
    scene.write("data/info.txt", kFrameInfo);
    CHECK(nominalWarning(scene.path() / "data") == "");
    std::string other = kFrameInfo;
    scene.write("data/info.txt", other.insert(other.find("Intrinsic") + 9, "s"));
    mentions(nominalWarning(scene.path() / "data"), "info.txt has no m_calibrationDepthIntrinsic");
}

TEST_CASE(
    "A calibration of images frame-N in UTF-16 is refused as such, and beside their folder in the warning") {
    const TemporaryFolder scene;
    addFrame(scene.path() / "data");
    scene.write("data/info.txt", asUtf16(kFrameInfo));
    mentions(recordingRefusal(scene.path() / "data", kFramesOnly), "info.txt: content: UTF-16 text");
    fs::rename(scene.path() / "data/info.txt", scene.path() / "info.txt");
    mentions(nominalWarning(scene.path() / "data"), "info.txt: content: UTF-16 text");
}

TEST_CASE("Poses of images frame-N belong to their number, whatever word their depth has") {
    for (const char* kind : {"depth", "rendered.depth"}) {
        CAPTURE(kind);
        const TemporaryFolder folder;
        addFrame(folder.path(), kind);
        folder.write("frame-000000.pose.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
        RecordedCamera camera(folder.path(), kFramesOnly);
        CHECK_FALSE(camera.info().poseless);
        const auto frame = camera.next();
        REQUIRE(frame);
        REQUIRE((*frame)->baseTcamera);
        CHECK((*frame)->baseTcamera->position.x == 0.5);
        folder.write("frame-000000.rendered.pose.txt", "1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
        const double own = std::string(kind) == "depth" ? 0.5 : 0.25;
        CHECK(RecordedCamera(folder.path(), kFramesOnly).next().value()->baseTcamera->position.x == own);
    }
}

TEST_CASE("Images frame-N have the lens of a text file of one matrix that lies with them or above") {
    for (const char* name : {"scene/camera-intrinsics.txt", "camera-intrinsics.txt", "scene/intrinsics.txt",
                             "scene/camera_intrinsics.txt"}) {
        const TemporaryFolder folder;
        addPair(folder, "scene/frame-000000.depth.png", "scene/frame-000000.color.png", 500);
        folder.write(name, " 5.25e+00\t 0.0e+00\t 3.5\n 0 5.5 2.5\n 0 0 1\n");
        RecordedCamera camera(folder.path() / "scene");
        CHECK(camera.info().registered);
        CHECK(camera.info().depth.fx == 5.25);
        CHECK(camera.info().depth.cy == 2.5);
        CHECK(camera.info().depth.width == kSmallWidth);
        CHECK(camera.warnings().empty());
        CHECK(camera.next());
        folder.write(name, "1 2 3\n");
        mentions(RecordedCamera(folder.path() / "scene").warnings().at(0), "nominal lens of 7-Scenes");
        mentions(RecordedCamera(folder.path() / "scene").warnings().at(0),
                 "intrinsics.txt: matrix: 3 numbers");
    }
}
