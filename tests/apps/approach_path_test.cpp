// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/approach_path.h"

#include "devices/simulated/simulated_camera.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <vector>

using namespace fathom;

namespace {

// The tank's first frame as a fixture set: spheres of 4 cm on a third of the valves' pixels. Row 0 is an
// placed shape, row 1 the red valve, row 2 a class without points, row 3 the yellow valve, row 4 guidance.
struct Setting {
    Scene scene;
    HostFixtures set;
    RegionGrid grid;
};

void addSpheres(HostFixtures& set, const SimulatedCamera& camera, const Pose& baseTscene, uint8_t object,
                uint8_t row) {
    const SimulatedCamera::ExactView view = camera.exactView(0);
    for (uint32_t pixel = 0; pixel < view.depth.size(); pixel += 3) {
        const int solid = view.solid[pixel];
        if (solid < 0 || camera.scene().solids[static_cast<size_t>(solid)].object != object) {
            continue;
        }
        const Intrinsics& lens = camera.info().depth;
        const uint32_t down = pixel / lens.width;
        const glm::dvec2 ray = lens.ray(pixel % lens.width, down);
        const dvec3 p = baseTscene.apply(view.depth[pixel] * dvec3(ray.x, ray.y, 1.0)) - set.origin;
        set.spheres.add(p, 0.04, pixel, row);
    }
}

Setting tankSetting(const Pose& baseTscene = {}) {
    SimulatedCameraOptions options;
    options.width = 320, options.height = 240;
    const SimulatedCamera camera(*analyticScene("tank"), options);
    Setting s;
    s.scene.fixtures.resize(5);
    s.scene.fixtures[0].shape = ShapeKind::Box;
    s.scene.fixtures[4].role = Role::Guidance;
    s.set.baseTcamera = baseTscene;
    s.set.origin = baseTscene.position;
    addSpheres(s.set, camera, baseTscene, 1, 1);
    addSpheres(s.set, camera, baseTscene, 2, 3);
    GuidancePose guidance;
    guidance.fixture = 4, guidance.present = true, guidance.count = 100;
    guidance.target.position = baseTscene.apply({0.0, -0.15, 0.97});
    s.set.guidance = {guidance};
    s.grid.build(s.set.spheres);
    return s;
}

Tool toolOf(const std::vector<Sphere>& leaves) {
    return Tool(buildSphereTree(leaves));
}

double bruteGap(const Setting& s, const Tool& tool, const Pose& pose, int row = -1) {
    double least = HUGE_VAL;
    for (size_t i = 0; i < s.set.spheres.size(); ++i) {
        for (const Sphere& leaf : tool.leaves()) {
            const dvec3 centre =
                dvec3(s.set.spheres.x[i], s.set.spheres.y[i], s.set.spheres.z[i]) + s.set.origin;
            const double gap =
                glm::length(pose.apply(leaf.centre) - centre) - leaf.radius - s.set.spheres.radius[i];
            least = row < 0 || s.set.spheres.fixture[i] == row ? std::min(least, gap) : least;
        }
    }
    return least;
}

// The deepest point of the path within the regions of a row.
struct Visit {
    double first = -1.0, last = -1.0; // [s] first and last contact
    dvec3 touch{0.0}, deepest{0.0};   // [m] commanded positions
    double depth = 0.0;               // [m] depth of the commanded position beyond the touch
    double turned = 0.0;              // [rad]
};

Visit visitOf(const Setting& s, const Tool& tool, const std::vector<HandWaypoint>& path, int row) {
    Visit visit;
    for (const HandWaypoint& w : path) {
        if (bruteGap(s, tool, w.deviceThandle, row) >= 0.0) {
            continue;
        }
        if (visit.first < 0.0) {
            visit.first = w.t, visit.touch = w.deviceThandle.position;
        }
        visit.last = w.t;
        visit.turned = std::max(visit.turned, glm::length(rotationLog(w.deviceThandle.rotation)));
        if (glm::length(w.deviceThandle.position - visit.touch) > visit.depth) {
            visit.deepest = w.deviceThandle.position;
            visit.depth = glm::length(visit.deepest - visit.touch);
        }
    }
    return visit;
}

const std::vector<Sphere> kBall = {{{0.0, 0.0, 0.0}, 0.01}};
const std::vector<Sphere> kLong = {
    {{0.0, 0.0, 0.0}, 0.01}, {{0.0, 0.08, -0.02}, 0.015}, {{0.0, 0.16, -0.04}, 0.02}};

} // namespace

TEST_CASE("The approach path pushes 20 mm into each forbidden region in file order and turns there") {
    for (const auto& leaves : {kBall, kLong}) {
        const Setting s = tankSetting();
        const Tool tool = toolOf(leaves);
        const std::vector<HandWaypoint> path = approachPath(s.scene, tool, s.set, s.grid);
        const Visit red = visitOf(s, tool, path, 1), yellow = visitOf(s, tool, path, 3);
        for (const Visit& visit : {red, yellow}) {
            REQUIRE(visit.first > 0.0);
            CHECK(visit.depth <= 0.0200001);
            CHECK(visit.depth > 0.0185); // the first waypoint inside is up to a step (1 mm) past the touch
            CHECK(visit.last - visit.first > 2.0);
            CHECK(visit.turned * 180.0 / std::acos(-1.0) == doctest::Approx(4.0).epsilon(0.01));
        }
        CHECK(red.last < yellow.first);
        // The tool just touches 20 mm before the deepest point, with the orientation of the base frame.
        for (const auto& [visit, row] : {std::pair{red, 1}, std::pair{yellow, 3}}) {
            const dvec3 back = glm::normalize(visit.touch - visit.deepest);
            CHECK(std::abs(bruteGap(s, tool, {visit.deepest + 0.02 * back, dquat(1, 0, 0, 0)}, row)) < 1e-6);
        }
    }
}

TEST_CASE(
    "The approach path starts and ends clear of every region on the camera's side and is smooth and slow") {
    const Setting s = tankSetting();
    for (const auto& leaves : {kBall, kLong}) {
        const Tool tool = toolOf(leaves);
        const std::vector<HandWaypoint> path = approachPath(s.scene, tool, s.set, s.grid);
        CHECK(path.front().t == 0.0);
        for (const HandWaypoint& end : {path.front(), path.back()}) {
            CHECK(bruteGap(s, tool, end.deviceThandle) >= 0.03);
            CHECK(end.deviceThandle.position.z < 0.8);
            CHECK(end.buttons == 0);
        }
        double fastest = 0.0, sharpest = 0.0;
        for (size_t i = 1; i < path.size(); ++i) {
            CHECK(path[i].t - path[i - 1].t == doctest::Approx(0.01));
            const dvec3 step = path[i].deviceThandle.position - path[i - 1].deviceThandle.position;
            fastest = std::max(fastest, glm::length(step) / 0.01);
            if (i > 1) {
                const dvec3 before = path[i - 1].deviceThandle.position - path[i - 2].deviceThandle.position;
                sharpest = std::max(sharpest, glm::length(step - before) / 1e-4);
            }
        }
        MESSAGE("lasts ", path.back().t, " s, peak ", fastest, " m/s, ", sharpest, " m/s^2");
        CHECK(fastest <= 0.25);
        CHECK(fastest > 0.2);
        CHECK(sharpest < 3.0);
        CHECK(path.back().t > 3 * 2.0);
        CHECK(path.back().t < 60.0);
    }
}

TEST_CASE("Outside the pushes the approach path touches no region") {
    const Setting s = tankSetting();
    const Tool tool = toolOf(kLong);
    const std::vector<HandWaypoint> path = approachPath(s.scene, tool, s.set, s.grid);
    const Visit red = visitOf(s, tool, path, 1), yellow = visitOf(s, tool, path, 3);
    CHECK(red.last - red.first < 5.0);
    CHECK(yellow.last - yellow.first < 5.0);
    for (const HandWaypoint& w : path) {
        const bool pushing =
            (w.t >= red.first && w.t <= red.last) || (w.t >= yellow.first && w.t <= yellow.last);
        CHECK((pushing || bruteGap(s, tool, w.deviceThandle) >= 0.0));
    }
}

TEST_CASE("The approach path rests 60 mm before a guidance target with the button down for 1.5 s") {
    const Setting s = tankSetting();
    const std::vector<HandWaypoint> path = approachPath(s.scene, toolOf(kBall), s.set, s.grid);
    double first = -1.0, released = -1.0;
    for (const HandWaypoint& w : path) {
        if (w.buttons == 1) {
            first = first < 0.0 ? w.t : first;
            CHECK(glm::length(w.deviceThandle.position - s.set.guidance[0].target.position) ==
                  doctest::Approx(0.06).epsilon(1e-6));
        } else if (first >= 0.0 && released < 0.0) {
            released = w.t;
        }
    }
    CHECK(released - first == doctest::Approx(1.5).epsilon(1e-6));
}

TEST_CASE(
    "The approach path is the same seen from the camera when base frame and camera are far from the origin") {
    const Pose far{{5000.0, -2000.0, 40.0}, dquat(1.0, 0.0, 0.0, 0.0)};
    const Setting near = tankSetting(), away = tankSetting(far);
    const Tool tool = toolOf(kBall);
    const auto a = approachPath(near.scene, tool, near.set, near.grid);
    const auto b = approachPath(away.scene, tool, away.set, away.grid);
    for (const int row : {1, 3}) {
        const Visit here = visitOf(near, tool, a, row), there = visitOf(away, tool, b, row);
        CHECK(glm::length(there.deepest - far.position - here.deepest) < 1e-5);
    }
    CHECK(std::abs(a.back().t - b.back().t) < 0.1); // paths consist of whole waypoints
}

TEST_CASE("Without points to visit the approach path rests at a stance, and it skips guidance that is not "
          "present") {
    Setting s = tankSetting();
    s.set.spheres.resize(0);
    s.set.guidance[0].present = false;
    s.grid.build(s.set.spheres);
    const std::vector<HandWaypoint> path = approachPath(s.scene, toolOf(kBall), s.set, s.grid);
    REQUIRE_FALSE(path.empty());
    for (const HandWaypoint& w : path) {
        CHECK(w.deviceThandle.position == path.front().deviceThandle.position);
        CHECK(w.buttons == 0);
    }
    CHECK(HandPath(path).duration() >= 1.0);
}

TEST_CASE("The least gap over the grid equals brute force, with and without a class, up to its cap") {
    const Setting s = tankSetting();
    const Tool tool = toolOf(kLong);
    for (int i = 0; i < 60; ++i) {
        const Pose pose{{-0.3 + 0.01 * i, 0.05 * std::sin(i), 0.65 + 0.2 * std::cos(0.7 * i)},
                        rotationExp({0.1 * i, 0.3, -0.05 * i})};
        for (const int row : {-1, 1, 2, 3}) {
            const double gap = leastGap(tool, s.set, s.grid, pose, 0.05, row);
            CHECK(gap == doctest::Approx(std::min(0.05, bruteGap(s, tool, pose, row))).epsilon(1e-9));
        }
    }
}
