// SPDX-License-Identifier: Apache-2.0
// The plan: which passes, buffers and threads a scene gets on a device, with reasons. Pure data.
#include "engine/scene/plan.h"

#include "engine/types/error.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <set>

using namespace fathom;

namespace {

CameraInfo cameraOf(uint32_t width, uint32_t height) {
    CameraInfo camera;
    camera.depth.width = width, camera.depth.height = height;
    camera.depth.fx = camera.depth.fy = 500.0;
    camera.colour = camera.depth;
    return camera;
}

DeviceFacts deviceOf(DeviceKind kind) {
    DeviceFacts facts;
    facts.kind = kind;
    facts.maxInvocations = 1024;
    facts.maxTexels = 1u << 27; // enough for any image
    return facts;
}

FixtureClass points(Role role) {
    FixtureClass f;
    f.name = "class";
    f.role = role;
    return f;
}

Scene sceneOf(std::vector<FixtureClass> fixtures) {
    Scene scene;
    scene.fixtures = std::move(fixtures);
    return scene;
}

Plan planOf(const Scene& scene, const CameraInfo& camera = cameraOf(640, 480),
            DeviceKind kind = DeviceKind::Cpu, uint32_t leaves = 1) {
    return makePlan(scene, camera, leaves, deviceOf(kind));
}

uint64_t bytesOf(const Plan& plan) {
    uint64_t bytes = 0;
    for (const Plan::Item& item : plan.items) {
        bytes += item.bytes;
    }
    return bytes;
}

} // namespace

TEST_CASE("A scene without point classes has no pass, no buffer and no contact thread") {
    FixtureClass wall = points(Role::Forbidden);
    wall.shape = ShapeKind::Plane;
    for (const Scene& scene : {sceneOf({}), sceneOf({wall})}) {
        const Plan plan = planOf(scene);
        CHECK_FALSE((plan.passes || plan.spheres || plan.thin || plan.hold || plan.moments || plan.colour ||
                     plan.occlusion || plan.rays));
        CHECK(plan.query == Plan::Query::None);
        CHECK(plan.dispatchesPerFrame() == 0);
        CHECK(bytesOf(plan) == 0);
        CHECK(plan.has("haptic"));
        CHECK_FALSE(plan.has("contact"));
    }
}

TEST_CASE(
    "Guidance, forbidden classes, colour, filter, thinning and hold each add their passes and buffers") {
    Scene scene = sceneOf({points(Role::Guidance)});
    Plan plan = planOf(scene);
    CHECK(plan.moments);
    CHECK_FALSE((plan.spheres || plan.thin || plan.hold || plan.colour || plan.guidancePoints));
    CHECK(plan.query == Plan::Query::None);
    CHECK(plan.dispatchesPerFrame() == 4); // the list apart, as on any CPU device

    scene = sceneOf({points(Role::Forbidden)});
    plan = planOf(scene);
    CHECK((plan.spheres && plan.thin && plan.hold && !plan.moments && !plan.colour && !plan.box));
    CHECK(plan.query == Plan::Query::Cpu);
    CHECK(plan.dispatchesPerFrame() == 6); // spheres of patches that hold points and of others
    const Plan behindBus = planOf(scene, cameraOf(640, 480), DeviceKind::Discrete);
    CHECK((behindBus.pack && !plan.pack && behindBus.dispatchesPerFrame() == 4));
    CHECK((plan.onCpu && !behindBus.onCpu));
    CHECK((behindBus.keepDepth && !plan.keepDepth && !behindBus.tree));
    CHECK(plan.filterRadius == 2);
    CHECK((plan.edge && plan.isolation));

    scene.errorBudget = 0.0, scene.holdSeconds = 0.0, scene.filter.radius = 0, scene.filter.edge = 0.0;
    scene.filter.isolated = false;
    plan = planOf(scene);
    CHECK_FALSE((plan.thin || plan.hold || plan.edge || plan.isolation || plan.tiled));
    CHECK(plan.filterRadius == 0);
    CHECK(plan.dispatchesPerFrame() == 4);

    scene.fixtures.push_back(points(Role::Guidance));
    scene.fixtures[1].lightness = Band{0.1, 0.9};
    scene.fixtures[0].box = Box{dvec3(-1), dvec3(1)};
    plan = planOf(scene);
    CHECK((plan.colour && plan.moments && plan.box && !plan.occlusion && !plan.guidancePoints));
    CHECK(plan.classes == 2);
    scene.fixtures[1].trim = 0.1;
    CHECK(planOf(scene).guidancePoints);
}

TEST_CASE("Occlusion, colour and rays follow the camera") {
    Scene scene = sceneOf({points(Role::Forbidden)});
    CameraInfo camera = cameraOf(640, 480);
    camera.registered = false;
    CHECK_FALSE(planOf(scene, camera).occlusion); // no class asks for colour
    scene.fixtures[0].hue = Band{350, 10};
    CHECK(planOf(scene, camera).occlusion);
    CHECK(planOf(scene, camera).dispatchesPerFrame() == 7);
    camera.registered = true;
    CHECK_FALSE(planOf(scene, camera).occlusion);
    CHECK(planOf(scene, camera).colour);
    camera.hasColour = false;
    CHECK_FALSE(planOf(scene, camera).colour);
    CHECK_FALSE(planOf(scene, camera).rays);
    camera.depth.distortion[4] = 0.01;
    CHECK(planOf(scene, camera).rays);
}

TEST_CASE("Only a CPU device reads the memory of points as texels, and only with hold") {
    Scene scene = sceneOf({points(Role::Forbidden)});
    scene.holdSeconds = 0.5;
    const CameraInfo camera = cameraOf(640, 480);
    CHECK(planOf(scene, camera, DeviceKind::Cpu).memoryTexels);
    for (const DeviceKind kind : {DeviceKind::Discrete, DeviceKind::Integrated, DeviceKind::Other}) {
        CHECK_FALSE(planOf(scene, camera, kind).memoryTexels);
    }
    scene.holdSeconds = 0.0;
    CHECK_FALSE(planOf(scene, camera, DeviceKind::Cpu).memoryTexels);
}

TEST_CASE(
    "Tiles and the GPU query are for GPUs, depending on filter and tool size, unless the scene decides") {
    Scene scene = sceneOf({points(Role::Forbidden)});
    const CameraInfo camera = cameraOf(640, 480);
    CHECK(planOf(scene, camera, DeviceKind::Discrete).tiled);
    CHECK_FALSE(planOf(scene, camera, DeviceKind::Cpu).tiled);
    CHECK(planOf(scene, camera, DeviceKind::Cpu).filterBlock);
    CHECK_FALSE(planOf(scene, camera, DeviceKind::Discrete).filterBlock);
    scene.filter.radius = 1;
    CHECK_FALSE(planOf(scene, camera, DeviceKind::Discrete).tiled);
    CHECK(planOf(scene, camera, DeviceKind::Discrete, DeviceFacts{}.gpuQueryLeaves - 1).query ==
          Plan::Query::Cpu);
    CHECK(planOf(scene, camera, DeviceKind::Discrete, DeviceFacts{}.gpuQueryLeaves).query ==
          Plan::Query::Gpu);
    CHECK(planOf(scene, camera, DeviceKind::Cpu, DeviceFacts{}.gpuQueryLeaves).query == Plan::Query::Cpu);
    scene.contact.where = Scene::Contact::Where::Gpu;
    CHECK(planOf(scene, camera, DeviceKind::Cpu).query == Plan::Query::Gpu);
    scene.contact.where = Scene::Contact::Where::Cpu;
    CHECK(planOf(scene, camera, DeviceKind::Discrete, DeviceFacts{}.gpuQueryLeaves).query ==
          Plan::Query::Cpu);
    DeviceFacts small = deviceOf(DeviceKind::Integrated);
    small.maxInvocations = 128;
    CHECK(makePlan(scene, camera, 1, small).pixelGroup == 128);
    CHECK(planOf(scene, camera).pixelGroup == 256);
    scene.filter.radius = 10;
    small.maxSharedBytes = 16384; // what every device has
    CHECK(makePlan(scene, camera, 1, small).tiled);
    scene.filter.radius = 11; // 38 x 38 points of 12 bytes
    CHECK_FALSE(makePlan(scene, camera, 1, small).tiled);
    small.maxSharedBytes = 17328;
    CHECK(makePlan(scene, camera, 1, small).tiled);
}

TEST_CASE("Holes between points are checked only where neighbours can be a radius apart") {
    CameraInfo camera = cameraOf(640, 480);
    camera.depth.cx = 320.0, camera.depth.cy = 240.0;
    const double radius = 0.04, from = leaksFrom(camera.depth, radius);
    REQUIRE(from > 1.0);
    size_t holes = 0;
    for (uint32_t k = 0; k < 20000; ++k) { // corners and middle, every slope that counts as a surface
        const double u = k % 3 * 319.0, v = k / 3 % 3 * 239.0, z = from * (k % 100 + 1) / 101.0;
        const glm::dvec2 a = camera.depth.ray(u, v),
                         b = k % 2 == 0 ? camera.depth.ray(u + 1, v) : camera.depth.ray(u, v + 1);
        const double other = z * (0.9 + 0.2 * (k / 100 % 101) / 100.0);
        const double apart = glm::distance(dvec3(a * z, z), dvec3(b * other, other));
        holes += apart >= radius && std::abs(other - z) <= 0.7 * apart ? 1 : 0;
    }
    CHECK(holes == 0);
    Scene scene = sceneOf({points(Role::Forbidden)});
    scene.fixtures[0].radius = radius;
    scene.farZ = 0.99 * from;
    CHECK_FALSE(planOf(scene, camera).leaks);
    scene.farZ = 1.01 * from;
    CHECK(planOf(scene, camera).leaks);
    CameraInfo bent = camera;
    bent.depth.distortion[0] = 0.1;
    scene.farZ = 0.5;
    CHECK(planOf(scene, bent).leaks); // not known for such a lens
    CHECK_FALSE(planOf(sceneOf({points(Role::Guidance)}), bent).leaks);
}

TEST_CASE("Frames are read in place if the device imports pages, and spare processors share the publication "
          "of sets") {
    const Scene scene = sceneOf({points(Role::Forbidden)});
    const auto plan = [&](DeviceKind kind, uint32_t processors, uint64_t alignment) {
        DeviceFacts device = deviceOf(kind);
        device.hostProcessors = processors, device.hostPointerAlignment = alignment;
        return makePlan(scene, cameraOf(640, 480), 1, device);
    };
    CHECK(plan(DeviceKind::Cpu, 2, 4096).inPlace);
    CHECK(plan(DeviceKind::Discrete, 2, 64).inPlace);
    CHECK_FALSE(plan(DeviceKind::Discrete, 2, 0).inPlace);
    CHECK_FALSE(plan(DeviceKind::Discrete, 2, 65536).inPlace); // a camera's blocks are whole pages only
    CHECK(plan(DeviceKind::Discrete, 64, 0).publishers == 12);
    CHECK(plan(DeviceKind::Discrete, 16, 0).publishers == 12);
    CHECK(plan(DeviceKind::Discrete, 12, 0).publishers == 8);
    CHECK(plan(DeviceKind::Discrete, 8, 0).publishers == 4);
    CHECK(plan(DeviceKind::Discrete, 7, 0).publishers == 1);
    CHECK(plan(DeviceKind::Discrete, 4, 0).publishers == 1);
    CHECK(plan(DeviceKind::Cpu, 16, 0).publishers == 12); // which its passes need no more
    CHECK(plan(DeviceKind::Cpu, 2, 0).publishers == 2);
    CHECK(plan(DeviceKind::Cpu, 1, 0).publishers == 1);
    CHECK_FALSE(planOf(sceneOf({}), cameraOf(640, 480)).inPlace);
}

TEST_CASE("Every item has a reason; skipped items take no memory and others take some") {
    Scene all = sceneOf({points(Role::Forbidden), points(Role::Guidance)});
    all.fixtures[0].hue = Band{0, 10};
    all.contact.where = Scene::Contact::Where::Gpu;
    all.filter.memory = 30;
    CameraInfo camera = cameraOf(428, 240);
    camera.depth.distortion[0] = 0.1;
    camera.registered = false;
    DeviceFacts device = deviceOf(DeviceKind::Discrete);
    device.hostProcessors = 16;
    const Plan everything = makePlan(all, camera, 1, device), nothing = planOf(sceneOf({}), camera);
    CHECK(everything.items.size() == nothing.items.size());
    std::set<std::string> names;
    for (const Plan* plan : {&everything, &nothing}) {
        for (const Plan::Item& item : plan->items) {
            CAPTURE(item.name);
            CHECK_FALSE(item.why.empty());
            CHECK((item.kind == "pass" || item.kind == "buffer" || item.kind == "thread" ||
                   item.kind == "arm"));
            CHECK((item.bytes > 0) == (item.kind == "buffer" && item.in));
            // An arm changes the query, the host reads spheres in only one layout, and a GPU writes lists
            // while it marks.
            CHECK((plan == &nothing || item.in || item.kind == "arm" || item.name == "radii" ||
                   item.name == "list"));
            CHECK((plan == &everything || item.kind == "thread" || !item.in));
            CHECK((plan == &nothing || names.insert(item.kind + item.name).second));
        }
    }
    CHECK(everything.has("tree_query"));
    CHECK_FALSE(everything.has("no such thing"));
}

TEST_CASE("Patches and tree levels work for any size from 1x1 to 3840x2160; larger is rejected") {
    const PatchLayout one = patchLayout(1, 1);
    CHECK((one.across == 1 && one.down == 1 && one.levels.size() == 2 && one.nodes() == 17 &&
           one.slots() == 256));
    const PatchLayout odd = patchLayout(428, 240);
    CHECK((odd.across == 27 && odd.down == 15 && odd.patches() == 405 && odd.levels.size() == 5));
    const PatchLayout full = patchLayout(3840, 2160);
    CHECK((full.patches() == 32400 && full.levels.size() == 6 && full.slots() * 16ull <= (1ull << 27)));
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {16u, 16u}, {17u, 1u}, {3840u, 1u}, {1u, 2160u}, {640u, 480u}, {3840u, 2160u}}) {
        const PatchLayout layout = patchLayout(width, height);
        uint32_t first = 0;
        for (size_t l = 0; l < layout.levels.size(); ++l) {
            CHECK(layout.levels[l].first == first);
            first += layout.levels[l].across * layout.levels[l].down;
            if (l > 0) {
                CHECK(layout.levels[l].across == (layout.levels[l - 1].across + 3) / 4);
                CHECK(layout.levels[l].down == (layout.levels[l - 1].down + 3) / 4);
            }
        }
        CHECK(layout.levels.back().across * layout.levels.back().down == 1);
        CHECK(layout.nodes() == first);
    }
    for (const auto& [width, height] : {std::pair{0u, 1u}, {1u, 0u}, {3841u, 1u}, {1u, 2161u}}) {
        CHECK_THROWS_AS(patchLayout(width, height), BadInput);
    }
}

TEST_CASE("Every pixel has its own slot, in its patch and its 4x4 sub-patch") {
    const uint32_t width = 53, height = 38;
    const PatchLayout layout = patchLayout(width, height);
    std::set<uint32_t> slots;
    for (uint32_t v = 0; v < height; ++v) {
        for (uint32_t u = 0; u < width; ++u) {
            const uint32_t slot = slotOfPixel(u, v, layout.across);
            CHECK(slots.insert(slot).second);
            CHECK(slot < layout.slots());
            CHECK(slot / 256 == v / 16 * layout.across + u / 16);
            CHECK(slot / 16 == slotOfPixel(u / 4 * 4, v / 4 * 4, layout.across) / 16);
        }
    }
}
