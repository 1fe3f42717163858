// SPDX-License-Identifier: Apache-2.0
// Compares the region tree with the validator and the float64 twin.
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::test;

namespace {

struct TreeAgreement {
    uint32_t nodes = 0, escaped = 0, wrong = 0; // escaped: spheres outside their sub-patch's bound
    double centre = 0.0, radius = 0.0;          // [m] largest errors; relative for radii over 1 m
};

// Checks in float64 that every seen and held sphere is inside its sub-patch's bound. Returns the bounds.
std::vector<reference::Bound> checkLeaves(const CloudRig& rig, const std::vector<reference::Bound>& bounds,
                                          TreeAgreement& a) {
    const auto seen = rig.spheres();
    const auto held = rig.plan().hold ? rig.spheres(true) : std::vector<reference::RegionSphere>{};
    std::vector<reference::Bound> twin;
    for (size_t i = 0; i < bounds.size(); ++i) {
        const int across = static_cast<int>(rig.cycle().layout().across) * 4;
        const int u0 = static_cast<int>(i) % across * 4, v0 = static_cast<int>(i) / across * 4;
        std::vector<reference::RegionSphere> inside;
        for (int v = v0; v < std::min(v0 + 4, rig.height()); ++v) {
            for (int u = u0; u < std::min(u0 + 4, rig.width()); ++u) {
                const auto p = static_cast<size_t>(v * rig.width() + u);
                inside.push_back(seen[p]);
                inside.push_back(held.empty() ? reference::RegionSphere{} : held[p]);
            }
        }
        for (const reference::RegionSphere& s : inside) {
            a.escaped +=
                s.radius >= 0.0 &&
                !(glm::distance(s.centre - rig.origin(), bounds[i].centre - rig.origin()) + s.radius <=
                  bounds[i].radius);
        }
        twin.push_back(reference::boundOf(inside));
    }
    return twin;
}

void compare(const std::vector<reference::Bound>& here, const std::vector<reference::Bound>& there,
             TreeAgreement& a) {
    REQUIRE(here.size() == there.size());
    for (size_t i = 0; i < here.size(); ++i) {
        a.wrong += here[i].count != there[i].count || (here[i].radius < 0.0) != (here[i].count == 0);
        if (here[i].count != 0 && there[i].count != 0) {
            ++a.nodes;
            a.centre = std::max(a.centre, glm::distance(here[i].centre, there[i].centre));
            a.radius = std::max(a.radius,
                                std::abs(here[i].radius - there[i].radius) / std::max(1.0, there[i].radius));
        }
    }
}

// The twin computes each level from the device's level below, so that errors do not add up.
TreeAgreement checkTree(CloudRig& rig, const FrameReport& report) {
    auto levels = rig.tree();
    TreeAgreement a;
    compare(levels[0], checkLeaves(rig, levels[0], a), a);
    for (size_t l = 1; l < levels.size(); ++l) {
        compare(levels[l], reference::parents(rig.cycle().layout(), l, levels[l - 1]), a);
    }
    for (auto& level : levels) { // float32 centres relative to the origin are exact in float64
        for (reference::Bound& b : level) {
            b.centre -= rig.origin();
        }
    }
    CHECK(reference::validateTree(rig.cycle().layout(), levels) == "");
    CHECK(levels.back().size() == 1);
    CHECK(levels.back()[0].count == report.counts.spheres);
    CHECK(report.counts.nodes == a.nodes);
    CHECK(a.escaped == 0);
    CHECK(a.wrong == 0);
    return a;
}

// The CPU query needs no tree.
void withTree(Plan& plan) {
    plan.tree = true;
}

// As GPUs build it: within the passes `spheres` and `deliver`.
void withTreeByPatch(Plan& plan) {
    plan.tree = plan.byPixel = plan.pack = true;
}

} // namespace

TEST_CASE("Every leaf sphere is inside its sub-patch and every child inside its parent, up to one root, for "
          "every size") {
    TreeAgreement all;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig rig(c.scene, c.camera, withTree);
        const FrameReport report = rig.run(c.image);
        const TreeAgreement a = checkTree(rig, report);
        CHECK(a.centre < 1e-6);
        CHECK(a.radius < 2e-6); // rounded outward by 1e-6 (relative)
        all.nodes += a.nodes, all.centre = std::max(all.centre, a.centre),
                              all.radius = std::max(all.radius, a.radius);
    }
    CHECK(all.nodes > (kSanitized ? 2000 : 20000));
    MESSAGE("tree: largest error of a centre ", all.centre * 1e6, " um, of a radius ", all.radius * 1e6,
            " um over ", all.nodes, " nodes");
}

TEST_CASE(
    "The tree is valid for tall, wide and odd frames with held points, as CPU devices and as GPUs build it") {
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

TEST_CASE("A set without spheres has an empty root, and old data of unlisted patches never returns") {
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
        CHECK(rig.tree().back()[0].radius < 0.0);
        checkTree(rig, none);
    }
}

TEST_CASE("Without a GPU query no tree is built, but its nodes are counted") {
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
