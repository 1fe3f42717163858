// SPDX-License-Identifier: Apache-2.0
// Registration on a chessboard: recovers a known pose from a rendered image with depth.
#include "apps/register/board_corners.h"
#include "apps/register/board_finder.h"
#include "engine/types/error.h"
#include "tests/apps/point_pairs.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kColumns = 7, kRows = 4;
constexpr double kSquare = 0.04;

// 7 x 4 inner corners on a grey wall, seen by a depth and a colour camera, with 4 x 4 rays per pixel.
struct BoardImage {
    CameraInfo info = twoLensCamera();
    Pose cameraTboard;
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour;

    explicit BoardImage(double turn, double noise = 0.0, double blot = -1.0)
        : cameraTboard{{0.0, 0.0, 0.9},
                       rotationExp(dvec3(0.25, -0.35, 0.0)) * rotationExp(dvec3(0, 0, turn))} {
        cameraTboard.position = cameraTboard.position - cameraTboard.rotation * dvec3(0.12, 0.06, 0.0);
        std::mt19937 random(3);
        std::normal_distribution<double> error(0.0, 1.0);
        for (uint32_t i = 0; i < info.depth.pixels(); ++i) {
            const uint32_t row = i / 320;
            const dvec3 p = hitOnPlane(info.depth.ray(i % 320, row), cameraTboard);
            depth.push_back(
                static_cast<uint16_t>(std::lround((p.z + noise * error(random)) / info.metresPerUnit)));
        }
        const Pose colourTboard = info.colourTdepth * cameraTboard, boardTcolour = inverse(colourTboard);
        for (uint32_t i = 0; i < info.colour.pixels(); ++i) {
            const uint32_t row = i / 640;
            double sum = noise > 0.0 ? 4.0 * error(random) : 0.0;
            for (int s = 0; s < 16; ++s) {
                const int line = s / 4;
                const double u = i % 640 + (s % 4 - 1.5) / 4, v = row + (line - 1.5) / 4;
                sum +=
                    greyAt(boardTcolour.apply(hitOnPlane(info.colour.ray(u, v), colourTboard)), blot) / 16.0;
            }
            const auto grey = static_cast<uint32_t>(std::clamp(sum, 0.0, 255.0));
            colour.push_back(grey * 0x010101u | 0xff000000u);
        }
    }
    // The square beyond the first corner is dark.
    static double greyAt(const dvec3& p, double blot) {
        const int x = static_cast<int>(std::floor(p.x / kSquare)),
                  y = static_cast<int>(std::floor(p.y / kSquare));
        if (x < -1 || x >= static_cast<int>(kColumns) || y < -1 || y >= static_cast<int>(kRows)) {
            return 190.0;
        }
        if (glm::length(p - dvec3(0.08, 0.04, 0.0)) < blot) {
            return 120.0; // covered
        }
        return (x + y) % 2 == 0 ? 30.0 : 220.0;
    }
    Frame frame() const {
        Frame::Content content;
        content.depth = depth;
        content.colour = colour;
        return Frame(content, nullptr);
    }
    std::vector<uint8_t> grey() const {
        std::vector<uint8_t> out;
        for (const uint32_t c : colour) {
            out.push_back(static_cast<uint8_t>(c & 255));
        }
        return out;
    }
};

} // namespace

TEST_CASE("Corners of a chessboard are found to 0.2 pixels, in the board's order at any rotation") {
    for (const double turn : {0.0, 0.6, 1.6, 3.1, -2.2}) {
        CAPTURE(turn);
        const BoardImage image(turn);
        const auto corners = boardCorners(image.grey(), 640, 480, kColumns, kRows);
        REQUIRE(corners.size() == kColumns * kRows);
        double worst = 0.0;
        for (size_t i = 0; i < corners.size(); ++i) {
            const auto row = i / kColumns;
            const dvec3 own(kSquare * static_cast<double>(i % kColumns), kSquare * static_cast<double>(row),
                            0.0);
            const dvec3 p = image.info.colourTdepth.apply(image.cameraTboard.apply(own));
            worst = std::max(worst, glm::distance(corners[i], image.info.colour.project(p)));
        }
        MESSAGE("turned by " << turn << ": worst corner off by " << worst << " pixels");
        CHECK(worst < 0.2);
    }
}

TEST_CASE("A chessboard in colour and noisy depth gives the camera's pose to millimetres") {
    for (const double noise : {0.0, 0.003}) {
        const BoardImage image(0.3, noise);
        BoardFinder finder(image.info, {kColumns, kRows, kSquare, kBaseTcamera * image.cameraTboard});
        const std::vector<PointPair> pairs = finder.find(image.frame());
        REQUIRE(pairs.size() == kColumns * kRows);
        checkRegistered(pairs, noise, noise == 0.0 ? 0.003 : 0.006);
    }
}

TEST_CASE("A board that is partly covered, of another size, without depth or missing gives no corner") {
    CHECK(boardCorners(BoardImage(0.0, 0.0, 0.02).grey(), 640, 480, kColumns, kRows).empty());
    const BoardImage whole(0.0);
    CHECK(boardCorners(whole.grey(), 640, 480, kColumns - 1, kRows + 1).empty());
    CHECK(boardCorners(whole.grey(), 640, 480, kColumns + 1, kRows + 1).empty());
    CHECK(boardCorners(std::vector<uint8_t>(640 * 480, 90), 640, 480, kColumns, kRows).empty());
    CHECK(boardCorners(std::vector<uint8_t>(5 * 3, 90), 5, 3, kColumns, kRows).empty());
    std::vector<uint8_t> noise(640 * 480);
    std::mt19937 random(1);
    for (uint8_t& g : noise) {
        g = static_cast<uint8_t>(random());
    }
    CHECK(boardCorners(noise, 640, 480, kColumns, kRows).empty());
    BoardImage blind(0.0);
    std::fill(blind.depth.begin(), blind.depth.end(), uint16_t{0});
    CHECK(BoardFinder(blind.info, {kColumns, kRows, kSquare, Pose{}}).find(blind.frame()).empty());
}

TEST_CASE("A board's file is one row, and its corners distinguish its two ends") {
    const ScratchFolder folder;
    const auto read = [&](const std::string& text) {
        std::ofstream(folder.path() / "board.csv") << text;
        return readBoardPlace(folder.path() / "board.csv");
    };
    const BoardPlace place =
        read("# the dry dock's\ncolumns,rows,square_m,x,y,z,qx,qy,qz,qw\n7,4,0.04,1,2,3,0,0,0,2\n");
    CHECK(place.columns == 7);
    CHECK(place.rows == 4);
    CHECK(place.square == 0.04);
    CHECK(place.baseTboard.position == dvec3(1, 2, 3));
    CHECK(place.baseTboard.rotation == dquat(1, 0, 0, 0));
    for (const char* wrong :
         {"", "7,4,0.04,1,2,3,0,0,0\n", "7,5,0.04,1,2,3,0,0,0,1\n", "2,5,0.04,1,2,3,0,0,0,1\n",
          "7,4,-1,1,2,3,0,0,0,1\n", "7,4,0.04,1,2,3,0,0,0,0\n", "7,4,0.04,1,2,3,0,0,0,1,9\n",
          "7,4,0.04,1,2,3,0,0,0,1\n7,4,0.04,1,2,3,0,0,0,1\n"}) {
        CAPTURE(wrong);
        CHECK_THROWS_AS(read(wrong), BadInput);
    }
}
