// SPDX-License-Identifier: Apache-2.0
// Compares the allocated buffers with the plan, for the plans of all kinds of devices.
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

bool built(const gpu::Buffer& buffer) {
    return static_cast<bool>(buffer);
}

// Each buffer exists exactly when it is planned, and has the planned size.
void checkBuffers(const Plan& plan, const cloud::WorkBuffers& w, const cloud::SetBuffers& s,
                  uint64_t pixels) {
    CHECK(built(w.growth) == plan.thin);
    CHECK(built(w.nearest) == plan.occlusion);
    CHECK(built(w.rays) == plan.rays);
    for (const gpu::Buffer* b : {&w.seen, &w.kept, &w.keptTime, &w.memoryCounts}) {
        CHECK(built(*b) == plan.hold);
    }
    CHECK(built(w.heldRadii) == (plan.hold && !plan.pack));
    for (const gpu::Buffer* b :
         {&w.masks, &w.listed, &w.list, &w.counters, &w.points, &s.counters, &s.listed}) {
        CHECK(built(*b) == plan.passes);
    }
    CHECK(built(s.bits) == plan.spheres);
    CHECK(built(w.radii) == (plan.spheres && !plan.pack));
    CHECK(built(w.classes) == (plan.spheres && (!plan.pack || plan.classes > 1)));
    for (const gpu::Buffer* b : {&s.nodes, &s.nodeCounts, &s.spheres}) {
        CHECK(built(*b) == plan.tree);
    }
    CHECK(built(s.held) == (plan.tree && plan.hold));
    CHECK(built(s.classes) == (plan.tree && plan.classes > 1));
    CHECK(built(w.depth) == plan.keepDepth);
    for (const gpu::Buffer* b : {&s.packed, &s.places, &s.runs}) {
        CHECK(built(*b) == plan.pack);
    }
    CHECK(built(s.moments) == plan.moments);
    CHECK((built(s.points) && built(s.masks)) == plan.guidancePoints);
    const auto sizeOf = [&](const char* name, uint64_t bytes) {
        const auto item = std::find_if(plan.items.begin(), plan.items.end(), [&](const Plan::Item& i) {
            return i.kind == "buffer" && i.name == name;
        });
        REQUIRE(item != plan.items.end());
        CAPTURE(name);
        CHECK(item->in == (bytes != 0));
        CHECK((item->bytes + 15) / 16 * 16 == bytes);
    };
    sizeOf("masks and points", w.masks.bytes() + w.points.bytes());
    sizeOf("thinning cells", w.growth.bytes());
    sizeOf("rays", w.rays.bytes());
    sizeOf("rays on the host", plan.rays && plan.pack && !plan.beam ? (8 * pixels + 15) / 16 * 16 : 0);
    sizeOf("depth on the device", w.depth.bytes());
    sizeOf("memory of points", w.seen.bytes() + w.kept.bytes() + w.keptTime.bytes());
    sizeOf("sphere slots", s.spheres.bytes() + s.held.bytes() + s.classes.bytes());
    sizeOf("radii", w.radii.bytes() + w.heldRadii.bytes());
    sizeOf("classes of spheres", w.classes.bytes());
    sizeOf("packed spheres", s.packed.bytes() + s.places.bytes() + s.runs.bytes());
    sizeOf("tree nodes", s.nodes.bytes() + s.nodeCounts.bytes());
    sizeOf("moments", s.moments.bytes());
}

} // namespace

TEST_CASE("Each buffer exists exactly when planned and has the planned size, on CPU and GPU plans with "
          "either query") {
    using Where = Scene::Contact::Where;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        for (const DeviceKind kind : {DeviceKind::Cpu, DeviceKind::Discrete}) {
            for (const Where where : {Where::Cpu, Where::Gpu}) {
                DeviceFacts facts = vulkan().device.facts();
                facts.kind = kind;
                Scene scene = c.scene;
                scene.contact.where = where;
                const Plan plan = makePlan(scene, c.camera, 1, facts);
                const PatchLayout layout = patchLayout(c.camera.depth.width, c.camera.depth.height);
                checkBuffers(plan, cloud::WorkBuffers(vulkan().device, plan, layout, c.camera),
                             cloud::SetBuffers(vulkan().device, plan, layout), c.camera.depth.pixels());
            }
        }
    }
}
