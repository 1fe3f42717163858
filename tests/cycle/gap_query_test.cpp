// SPDX-License-Identifier: Apache-2.0
// Batches on the device against brute force in float64, equal to the last bit: images and tools of any size,
// held points, frozen classes, ties, and poses far away.
#include "engine/cloud/gap_query.h"
#include "engine/reference/contact_oracle.h"
#include "tests/cycle/red_and_blue.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Poses inside of, near and far from the scene at z = 1.
std::vector<Pose> somePoses(size_t count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> side(-0.5, 0.5), depth(-1.0, 2.0), turn(-3.0, 3.0);
    std::vector<Pose> poses;
    for (size_t i = 0; i < count; ++i) {
        poses.push_back({{side(random), side(random), depth(random)},
                         rotationExp({turn(random), turn(random), turn(random)})});
    }
    return poses;
}

// Checks a batch and returns the number of poses with an answer.
size_t checkBatch(cloud::GapQuery& query, const CloudRig& rig, const Tool& tool,
                  const std::vector<Pose>& poses) {
    std::vector<SmallestGap> found;
    query.setTool(tool);
    query.find(rig.set(), tool, poses, found);
    REQUIRE(found.size() == poses.size());
    size_t any = 0;
    for (size_t i = 0; i < poses.size(); ++i) {
        const SmallestGap truth = oracleSmallestPair(tool, poses[i], rig.host());
        CHECK(found[i].gap == truth.gap);
        CHECK(found[i] == truth);
        any += found[i].any() ? 1 : 0;
    }
    return any;
}

cloud::GapQuery queryOf(const CloudRig& rig, uint32_t capacity = 4096) {
    return cloud::GapQuery({&vulkan().device, rig.plan(), rig.layout(), rig.cycle().sets()}, capacity);
}

} // namespace

TEST_CASE("A batch of 0, 1 or many poses has the smallest gaps of images of any size, with held points") {
    const Tool tool = leafyTool(70, 0.2);
    for (const bool pack : {false, true}) {
        for (const std::pair<uint32_t, uint32_t>& size :
             std::vector<std::pair<uint32_t, uint32_t>>{{1u, 1u}, {17u, 33u}, {5u, 300u}, {129u, 65u}}) {
            CAPTURE(pack);
            CAPTURE(size.first);
            const CameraInfo camera = pinholeCamera(size.first, size.second);
            Scene scene = classesScene(3);
            scene.holdSeconds = 1.0;
            CloudRig rig(scene, camera, queriedByGpu(pack));
            cloud::GapQuery query = queryOf(rig);
            rig.run(drawnImage(camera, [](int, int) { return 0.0; })); // nothing
            CHECK(checkBatch(query, rig, tool, somePoses(3)) == 0);
            rig.run(drawnImage(camera, [](int u, int v) { return u + v == 0 ? 1.0 : 0.0; })); // one point
            checkBatch(query, rig, tool, somePoses(5));
            rig.run(drawnImage(camera, [](int, int) { return 1.0; })); // every point
            CHECK(checkBatch(query, rig, tool, {}) == 0);
            checkBatch(query, rig, tool, somePoses(1));
            rig.run(stressImage(camera, 3)); // with points held from before
            const size_t any = checkBatch(query, rig, tool, somePoses(33));
            CHECK(any == (rig.host().spheres.size() > 0 ? 33 : 0));
        }
    }
}

TEST_CASE("Tools of 1 to 1025 leaves, in any order, have the smallest gaps of one set") {
    const CameraInfo camera = pinholeCamera(81, 47);
    CloudRig rig(plainScene(), camera, queriedByGpu(false));
    rig.run(stressImage(camera, 5));
    cloud::GapQuery query = queryOf(rig);
    for (const size_t leaves : {513u, 1u, 2u, 512u, 1025u, 64u}) {
        CAPTURE(leaves);
        CHECK(checkBatch(query, rig, leafyTool(leaves, 0.1), somePoses(7)) == 7);
    }
}

TEST_CASE("Frozen classes count where they were frozen, and nowhere else") {
    const CameraInfo camera = pinholeCamera(60, 40);
    Scene scene = redAndBlueScene();
    CloudRig rig(scene, camera, queriedByGpu(false));
    cloud::GapQuery query = queryOf(rig);
    const auto show = [&](double z) {
        Image image = drawnImage(camera, [&](int, int) { return z; });
        for (size_t i = 0; i < image.colour.size(); ++i) {
            image.colour[i] = i % 2 == 0 ? 0xff2020c0 : 0xffc02020;
        }
        rig.run(image);
    };
    for (const bool frozen : {false, true, true, false}) {
        scene.fixtures[0].frozen = frozen;
        rig.cycle().setScene(scene);
        show(frozen ? 1.4 : 1.0);
        CHECK(checkBatch(query, rig, leafyTool(40, 0.1), somePoses(15)) == 15);
        show(0.7);
        CHECK(checkBatch(query, rig, leafyTool(40, 0.1), somePoses(15)) == 15);
    }
}

TEST_CASE("A flat tool before a flat wall has thousands of ties, and the answer grows to decide among them") {
    const CameraInfo camera = pinholeCamera(48, 48);
    CloudRig rig(plainScene(), camera, queriedByGpu(false));
    rig.run(drawnImage(camera, [](int, int) { return 1.0; }));
    std::vector<Sphere> plate;
    for (int i = 0; i < 100; ++i) {
        const int column = i % 10, row = i / 10;
        plate.push_back({{0.01 * column - 0.05, 0.01 * row - 0.05, 0.0}, 0.01});
    }
    const Tool tool(buildSphereTree(plate));
    cloud::GapQuery query = queryOf(rig, 1);
    std::vector<Pose> poses;
    for (const double z : {0.2, 0.9, 0.99, 1.0}) {
        poses.push_back({{0.0, 0.0, z}, {1, 0, 0, 0}});
    }
    CHECK(checkBatch(query, rig, tool, poses) == 4);
    CHECK(query.pairs() > 1);
}

TEST_CASE("Poses beyond 20 m and poses that are not finite are answered beside near ones") {
    const CameraInfo camera = pinholeCamera(33, 21);
    CloudRig rig(plainScene(), camera, queriedByGpu(false));
    rig.run(stressImage(camera, 9));
    std::vector<Pose> poses = somePoses(4);
    poses[1].position.x = 25.0;
    poses[2].position.y = -3e5;
    const Tool tool = leafyTool(20, 0.1);
    cloud::GapQuery query = queryOf(rig);
    CHECK(checkBatch(query, rig, tool, poses) == 4);
    poses[0].position.z = std::nan("");
    std::vector<SmallestGap> found;
    query.find(rig.set(), tool, poses, found);
    CHECK(std::isnan(found[0].gap));
    CHECK_FALSE(found[0].any());
    CHECK(found[3].any());
}
