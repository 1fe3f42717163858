// SPDX-License-Identifier: Apache-2.0
// Where the device answers contact queries, it answers about a set whose passes have completed, before the
// host has its copy.
#include "engine/cycle/contact_cycle.h"
#include "tests/cycle/red_and_blue.h"
#include "tests/cycle/same_contacts.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Frames in steps, and the same questions to the device and to the CPU.
struct StepRig {
    const CameraInfo camera = pinholeCamera(160, 90);
    Scene scene = redAndBlueScene();
    CloudRig rig;
    Tool tool{buildSphereTree(
        std::vector<Sphere>{{dvec3(-0.06, 0, 0), 0.01}, {dvec3(0.06, 0, 0), 0.01}, {dvec3(0.0), 0.02}})};
    ContactCycle cpu, gpu;
    uint32_t frames = 0;

    explicit StepRig(Plan::Query query, bool pack = false)
        : rig(
              scene, camera, [=](Plan& plan) { change(plan, query, pack); }, 2)
        , cpu({&vulkan().device, planOf(Plan::Query::Cpu), rig.layout(), sets()}, tool, 0.05)
        , gpu({&vulkan().device, planOf(query), rig.layout(), sets()}, tool, 0.05) {}
    static void change(Plan& plan, Plan::Query query, bool pack) {
        plan.query = query;
        plan.tree = query == Plan::Query::Gpu;
        plan.grid = !plan.tree;
        plan.pack = plan.byPixel = pack;
        plan.memoryTexels = plan.memoryTexels && !pack;
    }
    Plan planOf(Plan::Query query) const {
        Plan plan = rig.plan();
        plan.query = query;
        return plan;
    }
    cloud::FixturePool& sets() const { return rig.cycle().sets(); }

    void waitForDevice(const Image& image) {
        Frame::Content content;
        content.index = frames;
        content.sourceNumber = frames;
        content.captureTime = frames++ / 30.0;
        content.depth = image.depth;
        content.colour = image.colour;
        rig.cycle().upload(Frame(content, nullptr));
        rig.cycle().submit();
        rig.cycle().waitForDevice();
    }
    static Pose place() { return {{0.0, 0.0, 0.5}, {1, 0, 0, 0}}; }
    ContactSet onDevice() {
        ContactSet set;
        gpu.query(*sets().newestEarly(), place(), set);
        return set;
    }
    ContactSet onHost() {
        ContactSet set;
        cpu.query(*sets().newest(), place(), set);
        return set;
    }
};

} // namespace

TEST_CASE("The device answers about a completed set without its host copy, as the CPU does with it, also for "
          "leaves behind a surface") {
    for (const bool pack : {false, true}) {
        CAPTURE(pack);
        StepRig rig(Plan::Query::Gpu, pack);
        REQUIRE(rig.gpu.onDevice());
        const std::vector<std::pair<double, double>> walls{
            {0.6, 0.6}, {0.47, 0.55}, {0.47, 0.55}, {0.52, 0.46}, {0.8, 0.9}};
        size_t found = 0, behind = 0;
        for (const auto& [left, right] : walls) {
            rig.waitForDevice(redAndBlueImage(rig.camera, left, right));
            const auto complete = rig.sets().newest();
            CHECK((complete ? complete->host.generation : 0) + 1 == rig.frames);
            const ContactSet early = rig.onDevice();
            CHECK(early.generation == rig.frames);
            const FrameReport report = rig.rig.cycle().finish();
            CHECK(report.times.completed <= report.times.answerable);
            CHECK(report.times.answerable < report.times.collected);
            CHECK(report.answerableMs > 0.0);
            checkSameContacts(early, rig.onHost());
            found += early.size();
            behind += early.behind.size();
        }
        CHECK(found > 100);
        CHECK(behind >= 3);
    }
}

TEST_CASE("A set with a class that has just been frozen waits for its host copy, later ones do not") {
    StepRig rig(Plan::Query::Gpu);
    rig.waitForDevice(redAndBlueImage(rig.camera, 0.53, 0.52));
    rig.rig.cycle().finish();
    rig.scene.fixtures[0].frozen = true;
    rig.rig.cycle().setScene(rig.scene);
    rig.waitForDevice(redAndBlueImage(rig.camera, 0.54, 0.52));
    CHECK(rig.sets().newestEarly()->host.generation == 1);
    const FrameReport report = rig.rig.cycle().finish();
    CHECK(report.times.answerable == report.times.published);
    checkSameContacts(rig.onDevice(), rig.onHost());
    rig.waitForDevice(redAndBlueImage(rig.camera, 0.8, 0.51));
    const ContactSet early = rig.onDevice();
    CHECK(early.generation == 3);
    rig.rig.cycle().finish();
    checkSameContacts(early, rig.onHost());
    CHECK(std::count(early.fixture.begin(), early.fixture.end(), 0) > 0); // from the second frame
    rig.scene.fixtures[0].frozen = false;
    rig.rig.cycle().setScene(rig.scene);
    rig.waitForDevice(redAndBlueImage(rig.camera, 0.8, 0.51));
    const ContactSet released = rig.onDevice();
    CHECK(released.generation == 4);
    CHECK(std::count(released.fixture.begin(), released.fixture.end(), 0) == 0);
    rig.rig.cycle().finish();
    checkSameContacts(released, rig.onHost());
}

TEST_CASE("Where the CPU answers, no set is published before its host copy is complete") {
    StepRig rig(Plan::Query::Cpu);
    rig.waitForDevice(redAndBlueImage(rig.camera, 0.53, 0.52));
    CHECK_FALSE(rig.sets().newestEarly());
    const FrameReport report = rig.rig.cycle().finish();
    CHECK(rig.sets().newestEarly()->host.generation == 1);
    CHECK(report.times.answerable == report.times.published);
    CHECK(report.times.collected <= report.times.published);
}
