// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/worlds.h"

#include "apps/stability/image_fixtures.h"
#include "devices/recorded/recorded_camera.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/reference/contact_oracle.h"
#include "engine/types/angle.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

const dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

// Sets the centre and size of the hand's motion from the sphere positions, and the start on the camera's side
// with 20 mm of clearance.
void settle(World& world, const Pose& baseTcamera) {
    const RegionSpheres& s = world.fixtures.spheres;
    if (s.size() == 0) {
        throw Error("stability: " + world.name + " has no region");
    }
    dvec3 lo(1e9), hi(-1e9);
    for (size_t i = 0; i < s.size(); ++i) {
        const dvec3 p = world.fixtures.origin + dvec3(s.x[i], s.y[i], s.z[i]);
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    world.focus = 0.5 * (lo + hi);
    const dvec3 half = 0.5 * (hi - lo);
    world.arena = std::clamp(std::max({half.x, half.y, half.z}) + 0.06, 0.1, 0.3);
    const Tool tool = toolOf(world.leaves);
    const dvec3 toCamera = baseTcamera.position - world.focus;
    for (double share = 0.1; share < 3.0; share += 0.05) {
        world.start = {world.focus + share * toCamera, kUpright};
        if (oracleSmallestGap(tool, world.start, world.fixtures) > 0.02) {
            return;
        }
    }
    throw Error("stability: no free place before " + world.name);
}

World emptyWorld(const char* name, std::vector<Sphere> leaves, const dvec3& start) {
    World world;
    world.name = name;
    world.leaves = std::move(leaves);
    world.start = {start, kUpright};
    return world;
}

} // namespace

Tool toolOf(const std::vector<Sphere>& leaves) {
    return Tool(buildSphereTree(leaves));
}

Tool ballTool(double radius) {
    return toolOf({{dvec3(0.0), radius}});
}

std::vector<Sphere> crossLeaves(double radius) {
    std::vector<Sphere> leaves;
    for (int i = 0; i < 7; ++i) {
        leaves.push_back({dvec3(0, 0, 0.01 * i), radius});
    }
    leaves.push_back({dvec3(0.03, 0, 0.05), radius});
    leaves.push_back({dvec3(-0.03, 0, 0.05), radius});
    return leaves;
}

void addWall(HostFixtures& set, const dvec3& centre, const dvec3& u, const dvec3& v, double half,
             double spacing, double radius) {
    const int n = static_cast<int>(std::lround(half / spacing));
    for (int i = -n; i <= n; ++i) {
        for (int j = -n; j <= n; ++j) {
            set.spheres.add(centre + (spacing * i) * u + (spacing * j) * v, radius);
        }
    }
}

World movedBy(const World& world, const dvec3& way) {
    World out = world;
    out.fixtures.origin += way;
    out.fixtures.baseTcamera.position += way;
    out.start.position += way;
    out.focus += way;
    return out;
}

World wallWorld() {
    World w = emptyWorld("wall", crossLeaves(0.008), {0, 0, 0.09});
    addWall(w.fixtures, dvec3(0.0), kX, kY, 0.15, 0.008, 0.04);
    return w;
}

World cornerWorld() {
    World w = emptyWorld("corner", crossLeaves(0.008), {0.1, 0.1, 0.1});
    addWall(w.fixtures, dvec3(0.06, 0.06, 0), kX, kY, 0.15, 0.01, 0.03);
    addWall(w.fixtures, dvec3(0, 0.06, 0.06), kY, kZ, 0.15, 0.01, 0.03);
    addWall(w.fixtures, dvec3(0.06, 0, 0.06), kX, kZ, 0.15, 0.01, 0.03);
    return w;
}

World slotWorld() {
    World w = emptyWorld("slot", {{dvec3(0.0), 0.01}}, dvec3(0.0));
    addWall(w.fixtures, dvec3(0, 0, 0.031), kX, kY, 0.12, 0.005, 0.02);
    addWall(w.fixtures, dvec3(0, 0, -0.031), kX, kY, 0.12, 0.005, 0.02);
    return w;
}

World grooveWorld(double degrees) {
    World w = emptyWorld("groove", crossLeaves(0.006), dvec3(0.0));
    const double half = 0.5 * degrees * kDegree;
    for (const double side : {-1.0, 1.0}) {
        const dvec3 up(side * std::sin(half), 0, std::cos(half));
        addWall(w.fixtures, up * 0.15, kY, up, 0.15, 0.008, 0.02);
    }
    w.start.position = {0, 0, 0.34};
    return w;
}

World needleWorld() {
    World w =
        emptyWorld("needle", {{dvec3(0.0), 0.0005}, {dvec3(0, 0, 0.02), 0.0005}}, {0.006, 0.003, -0.01});
    w.arena = 0.012;
    for (int i = -20; i <= 20; ++i) {
        w.fixtures.spheres.add(dvec3(0, 0.0005 * i, 0), 0.0002);
        w.fixtures.spheres.add(dvec3(0, 0, 0.0005 * i), 0.0002);
        w.fixtures.spheres.add(dvec3(0.0005 * i, 0, 0.005), 0.0001);
    }
    return w;
}

World rubbleWorld() {
    World w = emptyWorld("rubble", crossLeaves(0.006), {0, 0, 0.29});
    Rng rng(99);
    for (int i = 0; i < 1500; ++i) {
        const dvec3 centre = rng.inCube(0.25);
        w.fixtures.spheres.add(centre, rng.logUniform(0.002, 0.02));
    }
    w.start.position = {0, 0, 0.30};
    return w;
}

World analyticWorld(const std::string& scene, double radius, bool noise) {
    SimulatedCameraOptions options;
    options.width = 160;
    options.height = 120;
    options.metresPerUnit = 0.0001;
    options.noise = noise;
    options.water = noise;
    options.motion = false;
    SimulatedCamera camera(analyticScene(scene).value(), options);
    World world = emptyWorld(scene.c_str(), crossLeaves(0.007), dvec3(0.0));
    ImageFixtures make(redScene(radius), camera.info(), false);
    world.fixtures = make.make(*camera.next().value());
    settle(world, world.fixtures.baseTcamera);
    return world;
}

std::filesystem::path recordingFolder(const std::string& name) {
    return std::filesystem::path("../shared/data") / name;
}

std::optional<World> recordedWorld(const std::string& sceneFile, const std::string& folder) {
    if (!std::filesystem::exists(recordingFolder(folder))) {
        return std::nullopt;
    }
    const Scene scene = loadScene(sceneFile);
    RecordedCamera camera(recordingFolder(folder));
    World world = emptyWorld(folder.c_str(), {}, dvec3(0.0));
    for (const auto& s : scene.tool.spheres) {
        world.leaves.push_back({dvec3(s[0], s[1], s[2]), s[3]});
    }
    ImageFixtures make(scene, camera.info(), false);
    world.fixtures = make.make(*camera.next().value());
    settle(world, world.fixtures.baseTcamera);
    return world;
}

} // namespace fathom::stability
