// SPDX-License-Identifier: Apache-2.0
// The GPU's contact query against the CPU's on images of any size, on what the passes leave of them, on
// frozen classes and for arms.
#include "engine/cloud/query_answer.h"
#include "engine/cycle/arm_setup.h"
#include "engine/cycle/contact_cycle.h"
#include "tests/cycle/red_and_blue.h"
#include "tests/cycle/same_contacts.h"
#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Both answers for the rig's newest set. arm: null = the tool at the pose.
struct Both {
    const CloudRig& rig;
    const Tool& tool;
    const ArmSetup* arm = nullptr;
    std::optional<ContactCycle> cpu, gpu;

    Both(const CloudRig& cloud, const Tool& asked, double reach, const ArmSetup* onArm = nullptr)
        : rig(cloud)
        , tool(asked)
        , arm(onArm) {
        Plan plan = rig.plan();
        const cloud::QueryContext context{&vulkan().device, plan, rig.layout(), rig.cycle().sets()};
        gpu.emplace(context, tool, reach, arm);
        plan.query = Plan::Query::Cpu;
        cpu.emplace(context, tool, reach, arm);
        CHECK(gpu->onDevice());
        CHECK_FALSE(cpu->onDevice());
    }
    size_t check(const ToolPlace& place) {
        ContactSet a, b;
        cpu->query(rig.set(), QueryPlace{place}, a);
        gpu->query(rig.set(), QueryPlace{place}, b);
        checkSameContacts(a, b);
        CHECK(rig.set().largestRadius == rig.set().grid.get().maxRadius());
        return b.size();
    }
};

} // namespace

TEST_CASE("Both queries agree on full, sparse and empty images of odd sizes, with several classes and held "
          "points") {
    const Tool tool = leafyTool(70, 0.3);
    size_t found = 0;
    for (const bool pack : {false, true}) {
        for (const std::pair<uint32_t, uint32_t>& size : std::vector<std::pair<uint32_t, uint32_t>>{
                 {1u, 1u}, {16u, 16u}, {17u, 33u}, {300u, 5u}, {5u, 300u}, {129u, 65u}}) {
            CAPTURE(pack);
            CAPTURE(size.first);
            CAPTURE(size.second);
            const CameraInfo camera = pinholeCamera(size.first, size.second);
            Scene scene = classesScene(3);
            scene.holdSeconds = 1.0;
            CloudRig rig(scene, camera, queriedByGpu(pack));
            Both both(rig, tool, 0.05);
            const auto ask = [&] {
                for (const double z : {0.5, 0.9, 1.3}) {
                    found += both.check({Pose{{0.05, -0.02, z}, rotationExp({0.4, z, -1.0})}, {}});
                }
            };
            rig.run(drawnImage(camera, [](int, int) { return 0.0; })); // nothing
            CHECK(both.check({Pose{{0, 0, 1}, {1, 0, 0, 0}}, {}}) == 0);
            rig.run(drawnImage(camera, [](int u, int v) { return u + v == 0 ? 1.0 : 0.0; })); // one point
            ask();
            rig.run(drawnImage(camera, [](int, int) { return 1.0; })); // every point
            ask();
            rig.run(stressImage(camera, 3)); // with points held from before
            ask();
        }
    }
    CHECK(found > 5000);
}

TEST_CASE("A device without subgroup arithmetic lists the same pairs") {
    const CameraInfo camera = pinholeCamera(129, 65);
    CloudRig rig(plainScene(), camera, queriedByGpu(false));
    rig.run(drawnImage(camera, [](int, int) { return 1.0; }));
    const Tool tool = leafyTool(300, 0.2);
    const Pose pose{{0, 0, 0.9}, {1, 0, 0, 0}};
    std::vector<ContactSet> sets(2);
    for (const bool subgroups : {true, false}) {
        cloud::TreeQuery query({&vulkan().device, rig.plan(), rig.layout(), rig.cycle().sets()}, 64,
                               subgroups);
        CHECK(query.passesProbe());
        query.setTool(tool);
        NearPairs near;
        DecideScratch scratch;
        fillContactSet(tool, pose, 0.01, rig.host(), {}, sets[subgroups]);
        CHECK(query.list(rig.set(), pose, 0.01, near));
        CHECK(decidePairs(tool, near, SIZE_MAX, scratch, sets[subgroups]));
    }
    checkSameContacts(sets[0], sets[1]);
    CHECK(sets[0].size() > 100);
}

TEST_CASE("The GPU decides nearly all pairs, and as the host would") {
    const CameraInfo camera = pinholeCamera(129, 65);
    CloudRig rig(plainScene(), camera, queriedByGpu(false));
    rig.run(drawnImage(camera, [](int, int) { return 1.0; }));
    const Tool tool = leafyTool(300, 0.2);
    cloud::TreeQuery query({&vulkan().device, rig.plan(), rig.layout(), rig.cycle().sets()});
    query.setTool(tool);
    for (const double reach : {1e-9, 0.002, 0.01, 0.1}) {
        CAPTURE(reach);
        const Pose pose{{0, 0, 0.9}, {1, 0, 0, 0}};
        NearPairs near;
        REQUIRE(query.list(rig.set(), pose, reach, near));
        std::vector<uint32_t> undecided(near.buckets.begin(), near.buckets.end());
        const auto open =
            std::ranges::count_if(undecided, [](uint32_t b) { return b >= NearPairs::kUndecided; });
        CHECK(undecided.size() > 100);
        CHECK(static_cast<size_t>(open) < undecided.size() / 20);
        std::ranges::for_each(undecided, [](uint32_t& b) { b |= NearPairs::kUndecided; });
        ContactSet byDevice, byHost;
        DecideScratch scratch;
        fillContactSet(tool, pose, reach, rig.host(), {}, byDevice);
        fillContactSet(tool, pose, reach, rig.host(), {}, byHost);
        CHECK(decidePairs(tool, near, SIZE_MAX, scratch, byDevice));
        near.buckets = undecided;
        CHECK(decidePairs(tool, near, SIZE_MAX, scratch, byHost));
        checkSameContacts(byDevice, byHost);
    }
}

TEST_CASE("Both queries agree while a class is frozen, while two are, and after they are released") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene scene = redAndBlueScene();
    CloudRig rig(scene, camera, queriedByGpu(false));
    const Tool tool = leafyTool(40, 0.2);
    Both both(rig, tool, 0.02);
    const auto ask = [&](double z) { return both.check({Pose{{0.0, 0.0, z}, {1, 0, 0, 0}}, {}}); };
    const auto show = [&](double depth) { rig.run(redAndBlueImage(camera, depth, depth)); };
    const auto freeze = [&](bool red, bool blue) {
        scene.fixtures[0].frozen = red;
        scene.fixtures[1].frozen = blue;
        rig.cycle().setScene(scene);
    };
    show(1.0);
    const size_t all = ask(1.0);
    REQUIRE(all > 100);
    freeze(true, false);
    show(1.0); // red stays there
    CHECK(ask(1.0) == all);
    show(1.6);
    CHECK(ask(1.0) > 0);
    CHECK(ask(1.0) < all);
    CHECK(ask(1.6) > 0);
    freeze(true, true);
    show(1.6); // blue stays there
    show(2.4);
    CHECK(ask(1.0) > 0);
    CHECK(ask(1.6) > 0);
    CHECK(ask(2.4) == 0);
    freeze(false, true);
    show(2.4);
    CHECK(ask(1.0) == 0);
    CHECK(ask(1.6) > 0);
    CHECK(ask(2.4) > 0);
    freeze(false, false);
    show(1.0);
    CHECK(ask(1.0) == all);
    CHECK(ask(1.6) == 0);
}

TEST_CASE("Both queries agree for all links of an arm at several postures") {
    const CameraInfo camera = pinholeCamera(160, 120);
    Scene scene = plainScene();
    scene.baseTcamera.position = {0.5, 0.0, -1.03}; // looks along z at a plane next to the arm
    CloudRig rig(scene, camera, queriedByGpu(true));
    rig.run(drawnImage(camera, [](int, int) { return 1.0; }));
    ArmSetup arm;
    arm.model = testing::makeArm(4, 8);
    const Tool tool = arm.toolAt(arm.startPosture());
    Both both(rig, tool, 0.01, &arm);
    size_t found = 0;
    for (const double bend : {0.0, 0.3, -0.5, 1.0}) {
        ToolPlace place;
        place.arm = arm.startPosture();
        place.arm.q[0] = bend;
        place.arm.q[1] = -0.5 * bend;
        found += both.check(place);
    }
    CHECK(found > 100);
}

TEST_CASE("An answer whose counts passed 32 bits is not taken") {
    const auto found = [](uint32_t first, uint32_t count) {
        shared::FoundSphere f{};
        f.first = first, f.count = count;
        return f;
    };
    CHECK(cloud::agree({}, 0));
    const std::vector good{found(0, 3), found(3, 0), found(3, 5)};
    CHECK(cloud::agree(good, 8));
    CHECK_FALSE(cloud::agree(good, 7));
    CHECK_FALSE(cloud::agree(good, 9));
    const std::vector wrapped{found(0, 0xfffffff0), found(0xfffffff0, 24)}; // 8 in 32 bits
    CHECK_FALSE(cloud::agree(wrapped, 8));
    CHECK_FALSE(cloud::agree(std::vector{found(4, 4), found(0xfffffffe, 4)}, 8));
}
