// SPDX-License-Identifier: Apache-2.0
// Registration: recovers known poses from points and from tags in rendered images.
#include "apps/register/board_finder.h"
#include "apps/register/point_pairs.h"
#include "apps/register/tag_finder.h"
#include "engine/types/error.h"
#include "tests/apps/point_pairs.h"
#include "tests/support/scratch_folder.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Tag 7, 0.2 m wide, tilted, 1 m in front of a depth and a colour camera, rendered with rays through each
// pixel.
struct TagImage {
    CameraInfo info = twoLensCamera();
    Pose cameraTtag{{0.03, -0.02, 1.0}, glm::normalize(dquat(1.0, 0.12, -0.2, 0.05))};
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour;

    explicit TagImage(double noise) {
        std::mt19937 random(3);
        std::normal_distribution<double> error(0.0, noise);
        for (uint32_t i = 0; i < info.depth.pixels(); ++i) {
            const uint32_t row = i / 320;
            const dvec3 p = hitOnPlane(info.depth.ray(i % 320, row), cameraTtag);
            depth.push_back(static_cast<uint16_t>(std::lround((p.z + error(random)) / info.metresPerUnit)));
        }
        draw();
    }
    void draw() {
        apriltag_family_t* family = tag36h11_create();
        image_u8_t* tag =
            apriltag_to_image(family, 7); // 10 x 10 cells with the white border; the black square is 8 wide
        const Pose colourTtag = info.colourTdepth * cameraTtag, tagTcolour = inverse(colourTtag);
        for (uint32_t i = 0; i < info.colour.pixels(); ++i) {
            const uint32_t row = i / 640;
            int sum = 0;
            for (int s = 0; s < 16; ++s) { // 4 x 4 rays per pixel
                const int line = s / 4;
                const double u = i % 640 + (s % 4 - 1.5) / 4, v = row + (line - 1.5) / 4;
                const dvec3 p =
                    tagTcolour.rotation * hitOnPlane(info.colour.ray(u, v), colourTtag) + tagTcolour.position;
                const int x = static_cast<int>(std::floor(p.x / 0.025)) + 5,
                          y = static_cast<int>(std::floor(p.y / 0.025)) + 5;
                const bool on = x >= 0 && x < tag->width && y >= 0 && y < tag->height;
                sum += on ? tag->buf[y * tag->stride + x] : 200;
            }
            const auto grey = static_cast<uint32_t>(sum / 16);
            colour.push_back(grey * 0x010101u | 0xff000000u);
        }
        std::free(tag->buf); // freed here, because the library does not export its own function
        std::free(tag);
        tag36h11_destroy(family);
    }
    Frame frame() const {
        Frame::Content content;
        content.depth = depth;
        content.colour = colour;
        return Frame(content, nullptr);
    }
};

} // namespace

TEST_CASE("A pose is recovered from pairs of points up to rounding, and its sigma from noisy pairs") {
    const RigidFit exact = fitRigid(pairsOf(4, 0.0), "test");
    CHECK(glm::length(exact.baseTcamera.position - kBaseTcamera.position) < 1e-12);
    CHECK(angleBetween(exact.baseTcamera.rotation, kBaseTcamera.rotation) < 1e-7);
    CHECK(exact.sigma < 1e-12);
    const RigidFit noisy = fitRigid(pairsOf(500, 0.003), "test");
    CHECK(glm::length(noisy.baseTcamera.position - kBaseTcamera.position) < 0.002);
    CHECK(noisy.sigma == doctest::Approx(0.003 * std::sqrt(3.0)).epsilon(0.1)); // of three axes
    CHECK(noisy.worst > noisy.sigma);
}

TEST_CASE("Too few points, or points on a line, are rejected") {
    CHECK_THROWS_WITH_AS(fitRigid(pairsOf(3, 0.0), "p.csv"), doctest::Contains("p.csv: pairs: 3"), BadInput);
    std::vector<PointPair> twice = pairsOf(3, 0.0);
    twice.insert(twice.end(), 5, twice.front());
    CHECK_THROWS_WITH_AS(fitRigid(twice, "p.csv"), doctest::Contains("p.csv: pairs: 3"), BadInput);
    std::vector<PointPair> line;
    for (int i = 0; i < 9; ++i) {
        const dvec3 p(0.1 * i, 0.2 * i, 1.0);
        line.push_back({p, p, ""});
    }
    CHECK_THROWS_WITH_AS(fitRigid(line, "p.csv"), doctest::Contains("all on one line"), BadInput);
}

TEST_CASE("A tag in colour and noisy depth gives the camera's pose to millimetres") {
    for (const double noise : {0.0, 0.003}) {
        const TagImage image(noise);
        const Pose baseTtag = kBaseTcamera * image.cameraTtag;
        TagFinder finder(image.info, {{7, {0.2, baseTtag}}, {8, {0.2, Pose{}}}});
        const std::vector<PointPair> pairs = finder.find(image.frame());
        REQUIRE(pairs.size() == 4);
        checkRegistered(pairs, noise, noise == 0.0 ? 0.003 : 0.012);
    }
}

TEST_CASE("A tag that is not listed, or whose depth is missing or not a plane, is skipped") {
    TagImage image(0.0);
    CHECK(TagFinder(image.info, {{8, {0.2, Pose{}}}}).find(image.frame()).empty());
    TagFinder finder(image.info, {{7, {0.2, Pose{}}}});
    const std::vector<uint16_t> good = image.depth;
    for (size_t i = 0; i < image.depth.size(); i += 2) {
        image.depth[i] = static_cast<uint16_t>(image.depth[i] + 200); // every second pixel 0.1 m further
    }
    CHECK(finder.find(image.frame()).empty());
    std::fill(image.depth.begin(), image.depth.end(), uint16_t{0});
    CHECK(finder.find(image.frame()).empty());
    image.depth = good;
    CHECK(finder.find(image.frame()).size() == 4);
}

TEST_CASE("Lists of tags and points are read, and an invalid line is rejected with its number") {
    const ScratchFolder folder;
    const auto write = [&](const std::string& text) {
        std::ofstream(folder.path() / "a.csv") << text;
        return folder.path() / "a.csv";
    };
    const auto places = readTagPlaces(write("id,size_m,x,y,z,qx,qy,qz,qw\n# wall\n3,0.1,1,2,3,0,0,0,2\n"));
    CHECK(places.at(3).baseTtag.position.y == 2.0);
    CHECK(places.at(3).baseTtag.rotation.w == 1.0);
    CHECK_THROWS_WITH_AS(readTagPlaces(write("3,0.1,1,2,3,0,0,0\n")), doctest::Contains("line 1"), BadInput);
    CHECK_THROWS_AS(readTagPlaces(write("3,0,1,2,3,0,0,0,1\n")), BadInput);
    CHECK(readTagPlaces(write("586,0.1,1,2,3,0,0,0,1\n")).size() == 1);
    CHECK_THROWS_WITH_AS(readTagPlaces(write("587,0.1,1,2,3,0,0,0,1\n")),
                         doctest::Contains("ids from 0 to 586"), BadInput);
    CHECK_THROWS_AS(readTagPlaces(write("3,1,1,2,3,0,0,0,1\n3,1,1,2,3,0,0,0,1\n")), BadInput);
    CHECK_THROWS_AS(readTagPlaces(write("")), BadInput);
    const std::string header = "camera_x, camera_y,camera_z base_x,base_y,base_z\n";
    CHECK(readPointPairs(write(header + "1,2,3,4,5,6\n"))[0].base.z == 6.0);
    CHECK(readPointPairs(write("\xEF\xBB\xBF# by hand\n" + header + "1 2 3 4 5 6\n"))[0].base.z == 6.0);
    CHECK_THROWS_WITH_AS(readPointPairs(write("\n1,2,3,4,5\n")), doctest::Contains("line 2"), BadInput);
    CHECK_THROWS_WITH_AS(readPointPairs(write("1;2;3;4;5;6\n")), doctest::Contains("commas or spaces"),
                         BadInput);
    CHECK_THROWS_WITH_AS(readPointPairs(write("1,2,3,4,5,6\n1,2,-3,4,5,6\n")),
                         doctest::Contains("line 2: 1,2,-3,4,5,6, which is behind the camera (allowed: "
                                           "camera_z above 0"),
                         BadInput);
    CHECK_THROWS_WITH_AS(readPointPairs(write(header + "1,2,-3,4,5,6\n1,2,-4,4,5,6\n")),
                         doctest::Contains("camera_z: all 2 points are behind the camera (allowed: camera_z "
                                           "above 0"),
                         BadInput);
    CHECK_THROWS_AS(readPointPairs(folder.path() / "none.csv"), BadInput);
}

TEST_CASE("A list of points, tags or a board has its own header or none, and no names in front of rows") {
    const ScratchFolder folder;
    const auto file = folder.path() / "a.csv";
    const auto write = [&](const std::string& text) {
        std::ofstream(file) << text;
        return file;
    };
    const std::string points = "1,2,3,4,5,6\n", tag = "3,0.1,1,2,3,0,0,0,1\n",
                      board = "7,4,0.04,1,2,3,0,0,0,1\n";
    for (const char* header :
         {"camera_z,camera_y,camera_x,base_x,base_y,base_z",
          "base_x,base_y,base_z,camera_x,camera_y,camera_z", "cam,base", "camera_x,camera_y,camera_z"}) {
        CHECK_THROWS_WITH_AS(
            readPointPairs(write(header + ("\n" + points))),
            doctest::Contains("(allowed: header camera_x,camera_y,camera_z,base_x,base_y,base_z)"), BadInput);
    }
    for (const char* row :
         {"c4,1,2,3,4,5,6\n", "corner5 1,2,3,4,5,6\n", "camera_x,camera_y,camera_z,base_x,base_y,base_z\n"}) {
        CHECK_THROWS_WITH_AS(readPointPairs(write(points + row)), doctest::Contains("line 2"), BadInput);
    }
    CHECK_THROWS_WITH_AS(readTagPlaces(write("id,size_m,x,y,z,qw,qx,qy,qz\n" + tag)),
                         doctest::Contains("(allowed: header id,size_m,x,y,z,qx,qy,qz,qw)"), BadInput);
    CHECK_THROWS_WITH_AS(readTagPlaces(write(tag + "id7,0.1,1,2,3,0,0,0,1\n")), doctest::Contains("line 2"),
                         BadInput);
    CHECK_THROWS_WITH_AS(readBoardPlace(write("columns,rows,square_m,x,y,z,qw,qx,qy,qz\n" + board)),
                         doctest::Contains("(allowed: header columns,rows,square_m,x,y,z,qx,qy,qz,qw)"),
                         BadInput);
    CHECK(readBoardPlace(write(board)).columns == 7);
}

TEST_CASE("An endless line in a list of points, tags or a board is rejected before memory runs out") {
    const ScratchFolder folder;
    const std::filesystem::path hole = folder.path() / "hole.csv";
    std::ofstream(hole).close();
    std::filesystem::resize_file(hole, uint64_t{64} << 30); // a sparse file, which needs no disk space
    for (const auto& [file, why] :
         {std::pair(hole, "line 1"), {std::filesystem::path("/dev/zero"), "a pipe or device"}}) {
        CHECK_THROWS_WITH_AS(readPointPairs(file), doctest::Contains(why), BadInput);
        CHECK_THROWS_WITH_AS(readTagPlaces(file), doctest::Contains(why), BadInput);
        CHECK_THROWS_WITH_AS(readBoardPlace(file), doctest::Contains(why), BadInput);
    }
}
