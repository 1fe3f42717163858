// SPDX-License-Identifier: Apache-2.0
// Compares the bounds of spheres and patches with the validator and the float64 twin.
#include "apps/verify/pass_agreement.h"
#include "apps/verify/read_back.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <set>

using namespace fathom;
using namespace fathom::testing;

namespace {

verify::TreeAgreement checkTree(CloudRig& rig, const FrameReport& report) {
    const verify::TreeAgreement a = verify::treeAgreement(rig);
    const auto levels = rig.tree();
    CHECK(a.fault == "");
    uint32_t spheres = 0;
    for (const reference::Bound& patch : levels[1]) {
        spheres += patch.count;
    }
    CHECK(levels[1].size() == rig.layout().patches());
    CHECK(spheres == report.counts.spheres);
    CHECK(report.counts.nodes == a.nodes);
    CHECK(a.escaped == 0);
    CHECK(a.wrong == 0);
    return a;
}

// The CPU query needs no tree.
void withTree(Plan& plan) {
    plan.tree = true;
}

// As GPUs make them: within the passes `spheres` and `deliver`.
void withTreeByPatch(Plan& plan) {
    plan.tree = plan.byPixel = plan.pack = true;
}

} // namespace

TEST_CASE("Every sphere is inside its sub-patch and every sub-patch inside its patch, for every size") {
    verify::TreeAgreement all;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig rig(c.scene, c.camera, withTree);
        const FrameReport report = rig.run(c.image);
        const verify::TreeAgreement a = checkTree(rig, report);
        CHECK(a.centre < 1e-6);
        CHECK(a.radius < 2e-6);
        all.nodes += a.nodes, all.centre = std::max(all.centre, a.centre),
                              all.radius = std::max(all.radius, a.radius);
    }
    CHECK(all.nodes > (kSanitized ? 2000 : 20000));
    MESSAGE("tree: largest error of a centre ", all.centre * 1e6, " um, of a radius ", all.radius * 1e6,
            " um over ", all.nodes, " nodes");
}

TEST_CASE(
    "Bounds are valid for tall, wide and odd frames with held points, as CPU devices and as GPUs make them") {
    for (const std::pair<uint32_t, uint32_t>& size : std::vector<std::pair<uint32_t, uint32_t>>{
             {16u, 16u}, {17u, 16u}, {64u, 64u}, {65u, 64u}, {300u, 5u}, {5u, 300u}, {257u, 129u}}) {
        for (const auto change : {withTree, withTreeByPatch}) {
            CAPTURE(size.first);
            CAPTURE(size.second);
            CAPTURE((change == withTree));
            const CameraInfo camera = pinholeCamera(size.first, size.second);
            Scene scene = plainScene();
            scene.holdSeconds = 0.5;
            scene.errorBudget = 0.0002;
            CloudRig rig(scene, camera, change);
            rig.run(stressImage(camera, 50));
            const FrameReport report =
                rig.run(stressImage(camera, 51)); // other dropouts: some points are held
            checkTree(rig, report);
            const auto held = rig.spheres(true);
            CHECK(std::any_of(held.begin(), held.end(), [](const auto& s) { return s.radius >= 0.0; }));
        }
    }
}

TEST_CASE("Patches without spheres are empty, and old data of unlisted patches never returns") {
    for (const auto change : {withTree, withTreeByPatch}) {
        CAPTURE((change == withTree));
        const CameraInfo camera = pinholeCamera(100, 80);
        CloudRig rig(plainScene(), camera, change);
        checkTree(rig, rig.run(drawnImage(camera, [](int, int) { return 0.7; })));
        for (int frame = 0; frame < 4; ++frame) { // through all sets of the pool
            const FrameReport corner =
                rig.run(drawnImage(camera, [](int u, int v) { return u < 3 && v < 3 ? 0.7 : 0.0; }));
            CHECK(corner.counts.spheres == 9);
            CHECK(corner.counts.nodes == rig.cycle().layout().levels.size());
            checkTree(rig, corner);
        }
        const FrameReport none = rig.run(drawnImage(camera, [](int, int) { return 0.0; }));
        CHECK(none.counts.nodes == 0);
        CHECK(std::ranges::all_of(rig.tree()[1], [](const auto& patch) { return patch.radius < 0.0; }));
        checkTree(rig, none);
    }
}

TEST_CASE("A frame writes no node beyond those of its patches") {
    constexpr uint32_t kMark = 7;
    const CameraInfo camera = pinholeCamera(16, 16); // one patch, with padding behind its mark and its nodes
    CloudRig rig(plainScene(), camera, withTreeByPatch);
    std::set<const gpu::Buffer*> marked;
    for (int frame = 0; frame < 8; ++frame) { // each set of the pool comes again
        checkTree(rig, rig.run(drawnImage(camera, [](int, int) { return 0.0; })));
        const gpu::Buffer& buffer = rig.set().device.nodeCounts;
        if (marked.insert(&buffer).second) {
            gpu::Commands commands(vulkan().device);
            const gpu::Timeline timeline(vulkan().device);
            commands.begin();
            commands.fill(buffer, kMark);
            commands.end();
            vulkan().device.submit(commands.handle(), {}, {timeline.handle(), 1});
            timeline.wait(1);
            continue;
        }
        const auto counts = verify::readBack<uint32_t>(vulkan().device, buffer);
        REQUIRE(counts.size() > rig.layout().bounds());
        CHECK(std::all_of(counts.begin() + static_cast<std::ptrdiff_t>(rig.layout().bounds()), counts.end(),
                          [](uint32_t count) { return count == kMark; }));
    }
    CHECK(marked.size() < 8);
}

TEST_CASE("Without a GPU query no bounds are made, but nodes are counted alike") {
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig with(c.scene, c.camera, withTree), without(c.scene, c.camera);
        const FrameReport a = with.run(c.image), b = without.run(c.image);
        CHECK_FALSE((without.plan().tree || without.set().device.nodes));
        CHECK(a.counts.nodes == b.counts.nodes);
        CHECK(with.host().spheres.x == without.host().spheres.x);
        CHECK(with.host().spheres.radius == without.host().spheres.radius);
    }
}
