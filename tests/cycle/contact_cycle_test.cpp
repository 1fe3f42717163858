// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/contact_cycle.h"

#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/cycle/frame_cycle.h"
#include "tests/cycle/same_contacts.h"
#include "tests/support/vulkan.h"

#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using fathom::testing::checkSameContacts;
using fathom::testing::vulkan;

namespace {

Scene twoValves(double budget, double hold) {
    Scene scene;
    FixtureClass red;
    red.name = "red";
    red.hue = Band{345, 20};
    red.saturation = Band{0.4, 1};
    FixtureClass yellow = red;
    yellow.name = "yellow";
    yellow.hue = Band{40, 70};
    yellow.radius = 0.02;
    scene.fixtures = {red, yellow};
    scene.errorBudget = budget;
    scene.holdSeconds = hold;
    return scene;
}

// A tool with any number of leaves: spheres in a ball of 5 cm.
Tool randomTool(size_t leaves, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> side(-0.05, 0.05), radius(0.002, 0.01);
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < leaves; ++i) {
        spheres.push_back({{side(random), side(random), side(random)}, radius(random)});
    }
    return Tool(buildSphereTree(spheres));
}

struct ContactRig {
    Scene scene;
    SimulatedCamera camera;
    Plan plan;
    FrameCycle frames;

    ContactRig(Scene s, uint32_t frameCount)
        : scene(std::move(s))
        , camera(*analyticScene("tank"), options(frameCount))
        , plan(planFor(scene, camera))
        , frames(&vulkan().device, scene, camera.info(), plan, 2) {
        while (auto frame = camera.next()) {
            frames.process(std::move(*frame));
        }
    }
    static SimulatedCameraOptions options(uint32_t count) {
        SimulatedCameraOptions o;
        o.width = 320;
        o.height = 240;
        o.frames = count;
        return o;
    }
    static Plan planFor(Scene& scene, const SimulatedCamera& camera) {
        scene.contact.where = Scene::Contact::Where::Gpu; // so that sets have the data of the GPU query
        return makePlan(scene, camera.info(), 1, vulkan().device.facts());
    }
    cloud::QueryContext context() { return context(plan); }
    cloud::QueryContext context(const Plan& p) {
        return {&vulkan().device, p, frames.layout(), frames.sets()};
    }
};

size_t compareQueries(ContactRig& rig, const Tool& tool, double reach, uint32_t seed) {
    Plan onCpu = rig.plan;
    onCpu.query = Plan::Query::Cpu;
    ContactCycle cpu(rig.context(onCpu), tool, reach);
    ContactCycle gpu(rig.context(), tool, reach);
    CHECK(gpu.onDevice());
    const auto set = rig.frames.sets().newest();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(-0.25, 0.25), z(0.6, 1.0), step(-3.0, 3.0);
    size_t found = 0;
    for (int i = 0; i < 20; ++i) {
        const Pose pose{{x(random), 0.3 * x(random), z(random)},
                        rotationExp({step(random), step(random), step(random)})};
        ContactSet a, b;
        cpu.query(*set, pose, a);
        gpu.query(*set, pose, b);
        checkSameContacts(a, b);
        found += a.size();
    }
    return found;
}

} // namespace

TEST_CASE("The GPU and CPU queries give equal contact sets for tools of 1 to 4096 leaves") {
    ContactRig rig(twoValves(0.0001, 0.5), 3);
    for (size_t leaves : {1u, 8u, 300u, 4096u}) {
        CHECK(compareQueries(rig, randomTool(leaves, 7), 0.01, 11) > 0);
    }
}

TEST_CASE("Both queries agree for zero reach and for a reach over the whole scene") {
    ContactRig rig(twoValves(0.0, 0.0), 1);
    const Tool tool = randomTool(5, 3);
    compareQueries(rig, tool, 0.0001, 5);
    const size_t all = compareQueries(rig, tool, 0.9, 5);
    CHECK(all > 20 * rig.frames.sets().newest()->host.spheres.size() / 2);
}

TEST_CASE("A GPU answer that does not fit grows and keeps its whole reach") {
    ContactRig rig(twoValves(0.0, 0.0), 1);
    const Tool tool = randomTool(3, 3);
    cloud::TreeQuery small(rig.context(), 1), large(rig.context(), 1u << 17);
    const auto set = rig.frames.sets().newest();
    const Pose pose{{-0.15, 0, 0.80}, {1, 0, 0, 0}};
    small.setTool(tool);
    large.setTool(tool);
    NearPairs a, b;
    DecideScratch scratch;
    for (const double reach : {0.5, 0.001, 0.6}) { // the last one also needs another copy
        CHECK(small.list(*set, pose, reach, a));
        CHECK(large.list(*set, pose, reach, b));
        CHECK(a.spheres.size() == b.spheres.size());
        CHECK(a.buckets.size() == b.buckets.size());
        ContactSet one, other;
        fillContactSet(tool, pose, reach, set->host, {}, one);
        fillContactSet(tool, pose, reach, set->host, {}, other);
        CHECK(decidePairs(tool, a, SIZE_MAX, scratch, one));
        CHECK(decidePairs(tool, b, SIZE_MAX, scratch, other));
        checkSameContacts(one, other);
    }
    CHECK(small.capacity() >= b.spheres.size());
    CHECK(small.capacity() < 1u << 17);
}

TEST_CASE("The probe passes with the margin of the reach, and fails without it") {
    ContactRig rig(twoValves(0.0, 0.0), 1);
    cloud::TreeQuery query(rig.context());
    CHECK(query.passesProbe());
    CHECK_FALSE(query.passesProbe(5e-6));
    CHECK_FALSE(query.passesProbe(0.0, 0.0f));
    CHECK(query.passesProbe());
}

TEST_CASE("A contact answer that overflows certifies the reach that fits, and the next one the whole reach") {
    ContactRig rig(twoValves(0.0, 0.0), 1);
    const Tool tool = randomTool(3, 3);
    const Pose pose{{-0.15, 0, 0.80}, {1, 0, 0, 0}};
    const auto set = rig.frames.sets().newest();
    Plan onCpu = rig.plan;
    onCpu.query = Plan::Query::Cpu;
    const double reach = 0.1;
    ContactCycle cpu(rig.context(onCpu), tool, reach);
    ContactSet whole;
    cpu.query(*set, pose, whole);
    REQUIRE(whole.size() > 256);
    ContactCycle gpu(rig.context(), tool, reach, nullptr, {whole.size() - 1, whole.pairSphere.size()});
    ContactSet first, second;
    gpu.query(*set, pose, first);
    CHECK(first.reach < whole.reach);
    CHECK(first.reach > 0.49 * whole.reach - 1e-4);
    CHECK(first.size() < whole.size());
    CHECK(gpu.statistics().overflows == 1);
    // Certified: all spheres outside the set are farther than its reach from every leaf. Tests all spheres.
    PosedLeaves leaves;
    poseLeaves(tool, pose, set->host.origin, leaves);
    const RegionSpheres& all = set->host.spheres;
    size_t within = 0;
    for (size_t i = 0; i < all.size(); ++i) {
        double gap = 1e9;
        for (size_t l = 0; l < leaves.radius.size(); ++l) {
            const dvec3 between =
                dvec3(all.x[i], all.y[i], all.z[i]) - dvec3(leaves.x[l], leaves.y[l], leaves.z[l]);
            gap = std::min(gap, glm::length(between) - double{all.radius[i]} - double{leaves.radius[l]});
        }
        const bool listed =
            std::find(first.source.begin(), first.source.end(), all.source[i]) != first.source.end();
        within += gap <= first.reach ? 1 : 0;
        CHECK((listed || gap > first.reach));
    }
    CHECK(within > 0);
    gpu.query(*set, pose, second);
    checkSameContacts(second, whole);
    CHECK(gpu.statistics().overflows == 1);
}

TEST_CASE("A scene without forbidden points lets the tool go anywhere and uses no device") {
    Scene scene = twoValves(0.0, 0.0);
    for (FixtureClass& f : scene.fixtures) {
        f.role = Role::Guidance;
    }
    ContactRig rig(scene, 1);
    CHECK(rig.plan.query == Plan::Query::None);
    const Tool tool = randomTool(2, 1);
    ContactCycle contact(rig.context(), tool, 0.01);
    ContactSet set;
    contact.query(*rig.frames.sets().newest(), Pose{}, set);
    CHECK(set.size() == 0);
    CHECK(set.reach >= 100.0);
    CHECK(set.frame == 0);
    CHECK(contact.statistics().queries == 0);
}

TEST_CASE("A query reaches as much farther as the tool's motion needs, and names the step that asked") {
    const Tool tool = randomTool(4, 3);
    Plan plan;
    plan.query = Plan::Query::Cpu;
    cloud::FixturePool pool(2, [] { return std::make_unique<cloud::FixtureSet>(); });
    cloud::FixtureSet set;
    set.host.spheres.add({0.0, 0.0, 0.3}, 0.02);
    set.grid.build(set.host.spheres, nullptr);
    ContactCycle contacts(tool, 0.01, nullptr);
    const PatchLayout layout;
    contacts.use({nullptr, plan, layout, pool});
    QueryPlace at;
    ContactSet answer;
    for (const double more : {0.0, 0.005}) {
        at.extraReach = more;
        at.askedAt = 7.0 + more;
        contacts.query(set, at, answer);
        CHECK(answer.reach == doctest::Approx(0.01 + more));
        CHECK(answer.askedAt == at.askedAt);
    }
    CHECK(answer.query == 2);
}
