// SPDX-License-Identifier: Apache-2.0
// The device is opened again under running cycles: the active set stays, and later frames resume from it.
#include "engine/cycle/device_cycles.h"

#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/reference/contact_oracle.h"
#include "tests/rig/losing.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/vulkan.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>

using namespace fathom;
using fathom::testing::vulkan;

namespace {

constexpr uint32_t kFrames = 4;

Scene redValve(Scene::Contact::Where where) {
    Scene scene;
    FixtureClass red;
    red.name = "red";
    red.hue = Band{345, 20};
    red.saturation = Band{0.4, 1};
    scene.fixtures = {red};
    scene.contact.where = where;
    scene.holdSeconds = 0.0; // held points would be lost with the device
    return scene;
}

SimulatedCameraOptions images(uint32_t count) {
    SimulatedCameraOptions o;
    o.width = 160, o.height = 120;
    o.frames = count;
    return o;
}

struct TwinRig {
    Scene scene;
    SimulatedCamera camera{*analyticScene("tank"), images(kFrames)};
    Tool tool{buildSphereTree(std::vector<Sphere>{{dvec3(0.0), 0.01}, {dvec3(0.02, 0.0, 0.0), 0.01}})};
    DeviceCycles cycles;

    explicit TwinRig(Scene::Contact::Where where, const gpu::Instance& instance = vulkan().instance)
        : scene(redValve(where))
        , cycles({&instance, vulkan().device.facts().name, scene, camera.info(), tool, nullptr},
                 [this](const DeviceFacts& facts) { return makePlan(scene, camera.info(), 2, facts); }) {}

    FrameReport next() { return cycles.frames().process(std::move(*camera.next())); }
    // A tool at the first sphere of the newest set.
    QueryPlace place() {
        const auto set = cycles.frames().sets().newest();
        const RegionSpheres& s = set->host.spheres;
        REQUIRE(s.size() > 0);
        return {{Pose{set->host.origin + dvec3(s.x[0], s.y[0], s.z[0]), dquat(1.0, 0.0, 0.0, 0.0)}, {}}};
    }
};

} // namespace

TEST_CASE("A device that is opened again continues the origin and the generations, and equal frames give "
          "equal sets") {
    TwinRig rig(Scene::Contact::Where::Cpu), undisturbed(Scene::Contact::Where::Cpu);
    for (uint32_t i = 0; i < kFrames; ++i) {
        rig.next();
        undisturbed.next();
        {
            const auto a = rig.cycles.frames().sets().newest(),
                       b = undisturbed.cycles.frames().sets().newest();
            CHECK(a->host.generation == b->host.generation);
            CHECK(a->host.origin == b->host.origin);
            CHECK(a->host.spheres.x == b->host.spheres.x);
            CHECK(a->host.spheres.radius == b->host.spheres.radius);
            CHECK(a->host.spheres.source == b->host.spheres.source);
        }
        if (i < 2) {
            rig.cycles.renew();
            CHECK_FALSE(rig.cycles.frames().sets().newest());
        }
    }
    CHECK(rig.cycles.renewals() == 2);
}

TEST_CASE("Until the first frame on the new device the CPU answers from the last set, and query numbers only "
          "increase") {
    for (const auto where : {Scene::Contact::Where::Cpu, Scene::Contact::Where::Gpu}) {
        TwinRig rig(where);
        ContactSet before, between, after;
        CHECK_FALSE(rig.cycles.answer({}, before)); // no frame yet
        rig.next();
        const QueryPlace place = rig.place();
        REQUIRE(rig.cycles.answer(place, before));
        REQUIRE(before.size() > 0);
        rig.cycles.renew();
        REQUIRE(rig.cycles.answer(place, between));
        CHECK(between.generation == before.generation);
        CHECK(between.x == before.x);
        CHECK(between.radius == before.radius);
        CHECK(between.pairSphere == before.pairSphere);
        CHECK(between.query > before.query);
        rig.next();
        REQUIRE(rig.cycles.answer(place, after));
        CHECK(after.generation == before.generation + 1);
        CHECK(after.query > between.query);
        CHECK(rig.cycles.queryStatistics().queries == 3);
    }
}

TEST_CASE("Edits and frozen classes are kept when a device is opened again") {
    for (const bool anew : {false, true}) {
        CAPTURE(anew);
        TwinRig rig(Scene::Contact::Where::Cpu);
        rig.next();
        Scene edited = rig.scene;
        edited.fixtures[0].radius = 0.02;
        edited.fixtures[0].frozen = true;
        rig.cycles.frames().setScene(edited);
        rig.next(); // the class is frozen with the spheres of this frame
        const RegionSpheres held = rig.cycles.frames().sets().newest()->host.spheres;
        REQUIRE(held.size() > 0);
        if (anew) {
            rig.cycles.renew();
        }
        rig.next();
        const auto after = rig.cycles.frames().sets().newest();
        CHECK(after->host.spheres.x == held.x);
        CHECK(after->host.spheres.z == held.z);
        CHECK(after->host.spheres.radius == held.radius);
    }
}

TEST_CASE(
    "Batches are exact on the CPU and the device, before a frame, and from the last set of a lost device") {
    const std::vector<Pose> poses{{{0.0, 0.0, 0.3}, {1, 0, 0, 0}},
                                  {{0.4, -0.2, 1.0}, rotationExp({1, 2, 3})}};
    for (const auto where : {Scene::Contact::Where::Cpu, Scene::Contact::Where::Gpu}) {
        TwinRig rig(where);
        DeviceCycles::GapBatch batch;
        rig.cycles.smallestGaps(poses, batch);
        CHECK(batch.frame == -1);
        CHECK(batch.gaps.empty());
        CHECK(std::isnan(rig.cycles.clearance({poses[0], {}})));
        rig.next();
        const HostFixtures set = rig.cycles.frames().sets().newest()->host;
        for (const bool anew : {false, true}) {
            if (anew) {
                rig.cycles.renew();
            }
            rig.cycles.smallestGaps(poses, batch);
            CHECK(batch.frame == set.frame);
            CHECK(batch.captureTime == set.captureTime);
            REQUIRE(batch.gaps.size() == 2);
            for (size_t i = 0; i < 2; ++i) {
                CHECK(batch.gaps[i] == oracleSmallestPair(rig.tool, poses[i], set));
                CHECK(batch.gaps[i].gap == rig.cycles.clearance({poses[i], {}}));
            }
        }
    }
}

namespace {

// A device that is lost at the next submission after lose().
struct LosingRig {
    const testing::ScratchFolder folder;
    const std::string trigger = folder / "trigger";
    const Losing losing;
    const gpu::Instance instance{fathom::testing::Vulkan::validation()};
    TwinRig twin{Scene::Contact::Where::Gpu, instance};

    explicit LosingRig(const std::string& by = "lost")
        : losing(trigger, 0, by) {}

    void lose() const { std::ofstream(trigger) << "passes"; }
    void failNextWait() const { std::ofstream(trigger) << "waiting"; } // for want of memory
    void landNext() {
        twin.cycles.frames().upload(std::move(*twin.camera.next()));
        twin.cycles.frames().submit();
        twin.cycles.frames().waitForDevice();
    }
};

} // namespace

TEST_CASE(
    "After a loss between completion and the host's copy, the CPU answers about the newest complete copy "
    "with its own generation and time") {
    for (const bool copied : {false, true}) { // whether the host's copy is made after all
        CAPTURE(copied);
        LosingRig rig;
        DeviceCycles& cycles = rig.twin.cycles;
        rig.twin.next();
        const QueryPlace place = rig.twin.place();
        ContactSet first, given, late, after;
        REQUIRE(cycles.answer(place, first));
        REQUIRE(first.size() > 0);
        rig.landNext();
        REQUIRE(cycles.answer(place, given));
        CHECK(given.generation == 2);
        CHECK(given.captureTime > first.captureTime);
        rig.lose();
        REQUIRE(cycles.answer(place, late));
        CHECK_FALSE(std::filesystem::exists(rig.trigger)); // lost
        CHECK(late.query > given.query);
        CHECK(late.generation == 1);
        CHECK(late.captureTime == first.captureTime);
        CHECK(late.x == first.x);
        CHECK(late.pairSphere == first.pairSphere);
        if (copied) {
            cycles.frames().finish(); // needs no device
        }
        for (const bool renewed : {false, true}) {
            if (renewed) {
                cycles.renew();
            }
            REQUIRE(cycles.answer(place, after));
            const ContactSet& expected = copied ? given : first;
            CHECK(after.generation == expected.generation);
            CHECK(after.captureTime == expected.captureTime);
            CHECK(after.x == expected.x);
            CHECK(after.pairSphere == expected.pairSphere);
        }
        rig.landNext();
        REQUIRE(cycles.answer(place, after));
        CHECK(after.generation == 3); // the new device, again before the host's copy
    }
}

TEST_CASE("A device that is lost again before its first host copy leaves the CPU the copy of the first one") {
    LosingRig rig;
    DeviceCycles& cycles = rig.twin.cycles;
    rig.twin.next();
    const QueryPlace place = rig.twin.place();
    ContactSet first, set;
    REQUIRE(cycles.answer(place, first));
    cycles.renew();
    rig.landNext();
    REQUIRE(cycles.answer(place, set));
    CHECK(set.generation == 2);
    rig.lose();
    for (const bool renewed : {false, true}) {
        if (renewed) {
            cycles.renew();
        }
        REQUIRE(cycles.answer(place, set));
        CHECK(set.generation == 1);
        CHECK(set.x == first.x);
    }
}

TEST_CASE("A device without memory for its first submission is reported, and opened later") {
    LosingRig rig("memory");
    DeviceCycles& cycles = rig.twin.cycles;
    rig.twin.next();
    rig.lose();
    CHECK_THROWS_AS(cycles.renew(), OutOfMemory); // waited for ever once
    cycles.renew();
    CHECK(rig.twin.next().counts.spheres > 0);
}

TEST_CASE("The device is waited for although memory is short, because it still uses what would be freed") {
    LosingRig rig;
    DeviceCycles& cycles = rig.twin.cycles;
    rig.twin.next();
    const QueryPlace place = rig.twin.place();
    ContactSet set;
    rig.failNextWait();
    REQUIRE(cycles.answer(place, set));
    CHECK_FALSE(std::filesystem::exists(rig.trigger));
    rig.failNextWait();
    rig.landNext();
    CHECK_FALSE(std::filesystem::exists(rig.trigger));
    REQUIRE(cycles.answer(place, set));
    CHECK(set.generation == 2); // the device answers: there is no copy on the host yet
}
