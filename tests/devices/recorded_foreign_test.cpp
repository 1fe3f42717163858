// SPDX-License-Identifier: Apache-2.0
// Folders as other programs and systems leave them: damaged first images, other names, files of archives.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/played_bag.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::test;

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
        lineSays(recordingRefusal(folder->path()), "depth/0.png: image: ");
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

TEST_CASE("A lens of another size than colour is named with its file") {
    const TemporaryFolder folder;
    addThreePairs(folder, "color");
    folder.write("camera_intrinsic.json", kOpen3dLens);
    for (const char* name : {"color/0.png", "color/1.png", "color/2.png"}) {
        writeColour(folder.path() / name, 14, 10, 1, 2, 3);
    }
    lineSays(recordingRefusal(folder.path()), ": camera_intrinsic.json: color.width, color.height: ");
}
