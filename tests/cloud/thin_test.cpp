// SPDX-License-Identifier: Apache-2.0
// Compares thin.comp with its float64 twin and checks the required property: the kept spheres cover the whole
// region.
#include "apps/verify/pass_agreement.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kTolerance = 2.5e-7; // [m] loss of region by float32 rounding, metres from the origin

struct Thinned {
    uint32_t points = 0, spheres = 0;
    double largestGrowth = 0.0; // [m]
    reference::Coverage coverage;
    double share() const { return static_cast<double>(spheres) / std::max(points, 1u); }
};

// Draws points from the union of spheres of radius R around all forbidden points and tests whether the kept
// spheres contain them.
Thinned checkCoverage(const CloudRig& rig, uint32_t samples) {
    const auto all = reference::spheres(rig.scene(), rig.forbidden(), rig.points(), {});
    const auto kept = rig.spheres();
    Thinned k;
    k.coverage = reference::coverage(all, kept, samples, kTolerance, 7);
    for (size_t i = 0; i < all.size(); ++i) {
        k.points += all[i].radius >= 0.0;
        if (kept[i].radius >= 0.0) {
            ++k.spheres;
            REQUIRE(all[i].radius >= 0.0);
            k.largestGrowth = std::max(k.largestGrowth, kept[i].radius - all[i].radius);
            CHECK(kept[i].radius >= all[i].radius - 1e-8);
        }
    }
    return k;
}

// A long lens, so that pixel spacing is smaller than the regions: 1 mm at 0.6 m.
CameraInfo longLens(uint32_t width, uint32_t height) {
    CameraInfo camera = pinholeCamera(width, height, 0.0001);
    camera.depth.fx = camera.depth.fy = 600.0;
    camera.colour = camera.depth;
    return camera;
}

Scene budgetScene(double budget) {
    Scene scene = plainScene();
    scene.errorBudget = budget;
    return scene;
}

} // namespace

TEST_CASE("Thinning makes the twin's decisions with the same growth for every size and option, as a separate "
          "pass and within spheres") {
    verify::ThinAgreement all;
    std::vector<CloudCase> cases = cloudCases();
    std::erase_if(cases, [](const CloudCase& c) { return c.scene.errorBudget == 0.0; });
    for (size_t i = 0; i < 2 * cases.size(); ++i) {
        const CloudCase& c = cases[i / 2];
        const bool within = i % 2 == 1;
        CAPTURE(c.name);
        CAPTURE(within);
        CloudRig rig(c.scene, c.camera, [&](Plan& plan) {
            plan.byPixel = plan.pack = within;
            plan.pixelGroup = i % 4 == 1 ? 256 : 64;
        });
        CHECK(rig.plan().thins() != within);
        rig.run(c.image);
        const verify::ThinAgreement a = verify::thinAgreement(rig);
        CHECK(a.wrong == 0);
        CHECK(a.growth < 1e-6);
        all.cells += a.cells, all.thinned += a.thinned, all.unsure += a.unsure,
            all.growth = std::max(all.growth, a.growth);
    }
    CHECK(all.thinned > (kSanitized ? 20 : 100));
    MESSAGE("thin: largest error of a growth ", all.growth * 1e6, " um over ", all.thinned,
            " thinned cells of ", all.cells, " (4x4); ", all.unsure, " decisions on the budget differ");
}

TEST_CASE("Each of a cell's 25 points counts: one unlike the rest decides about its cell and its quarter") {
    const CameraInfo camera = longLens(68, 68);
    const auto isUnlike = [](int u, int v) { // one unlike point in every third cell across and down
        const int cell = u / 12 + v / 12 * 5;
        return u % 12 == 4 + cell % 5 && v % 12 == 4 + cell / 5;
    };
    Scene scene = budgetScene(0.0006);
    scene.fixtures = {forbiddenClass("red", 0.02), forbiddenClass("blue", 0.02)};
    scene.fixtures[0].hue = Band{330, 30}, scene.fixtures[1].hue = Band{200, 260};
    // Nearer by less and by more than the budget, missing, and of the other class.
    for (const double out : {0.0003, 0.001, 0.6, 0.0}) {
        Image image = drawnImage(camera, [&](int u, int v) { return isUnlike(u, v) ? 0.6 - out : 0.6; });
        for (size_t i = 0; i < image.colour.size(); ++i) {
            const bool blue = out == 0.0 && isUnlike(static_cast<int>(i % 68), static_cast<int>(i / 68));
            image.colour[i] = blue ? 0xffc02020 : 0xff2020c0;
        }
        for (const uint32_t group : {0u, 64u, 128u, 256u}) {
            CAPTURE(out);
            CAPTURE(group);
            CloudRig rig(scene, camera, [&](Plan& plan) {
                plan.byPixel = plan.pack = group != 0;
                plan.pixelGroup = group != 0 ? group : plan.pixelGroup;
            });
            rig.run(image);
            const verify::ThinAgreement a = verify::thinAgreement(rig);
            CHECK(a.wrong == 0);
            CHECK(a.unsure == 0);
            CHECK(a.growth < 1e-6);
            CHECK(a.thinned > 17 * 17 - 4 * 25);
        }
    }
}

TEST_CASE("Exactly the spheres of the twin's rule are kept") {
    for (const char* name : {"sphere", "corner"}) {
        SimulatedCameraOptions options;
        options.width = 163, options.height = 121, options.focal = 600, options.noise = false,
        options.metresPerUnit = 0.0001;
        const Shot shot = simulatedShot(name, options);
        Scene scene = budgetScene(0.0003);
        scene.filter.radius = 2;
        CloudRig rig(scene, shot.camera);
        rig.run(shot.image);
        const std::vector<double> growth = reference::keptGrowth(rig.width(), rig.height(), rig.thinning());
        const auto twin = reference::spheres(scene, rig.forbidden(), rig.points(), growth);
        const auto kept = rig.spheres();
        const reference::PointImage points = rig.points();
        uint32_t wrong = 0, left = 0;
        for (size_t i = 0; i < kept.size(); ++i) {
            wrong += (kept[i].radius >= 0.0) != (twin[i].radius >= 0.0);
            wrong += std::abs(kept[i].radius - twin[i].radius) > 1e-8;
            left += twin[i].radius < 0.0 && points.z[i] != 0.0;
        }
        CHECK(wrong == 0);
        CHECK(left > 1000);
    }
}

TEST_CASE("The kept spheres cover the whole region and none grows by more than the budget") {
    double worst = 0.0;
    uint32_t samples = 0;
    struct Row {
        std::string name;
        double radius, budget;
    };
    for (const Row& row :
         {Row{"sphere", 0.04, 0.0002}, Row{"torus", 0.02, 0.0005}, Row{"corner", 0.01, 0.001},
          Row{"plate", 0.04, 0.0003}, Row{"slot", 0.005, 0.0003}, Row{"tank", 0.03, 0.002}}) {
        CAPTURE(row.name);
        SimulatedCameraOptions options;
        options.width = 211, options.height = 157, options.focal = 600, options.metresPerUnit = 0.0001;
        options.noise = row.name == "tank";
        const Shot shot = simulatedShot(row.name, options);
        Scene scene = budgetScene(row.budget);
        scene.fixtures[0].radius = row.radius;
        scene.filter.radius = 2;
        CloudRig rig(scene, shot.camera);
        rig.run(shot.image);
        const Thinned k = checkCoverage(rig, 6000);
        CHECK(k.coverage.holes == 0);
        CHECK(k.largestGrowth <= row.budget + 1e-8);
        CHECK(k.spheres < k.points);
        MESSAGE(row.name, ": ", k.spheres, " of ", k.points, " points kept, largest growth ",
                k.largestGrowth * 1e3, " mm, farthest sample outside ", k.coverage.worst * 1e9, " nm");
        worst = std::max(worst, k.coverage.worst), samples += k.coverage.samples;
    }
    MESSAGE("coverage: ", samples, " samples, farthest outside ", worst * 1e9, " nm");
}

TEST_CASE("Overlapping classes with different radii are covered class by class") {
    const CameraInfo camera = longLens(160, 120);
    Scene scene = budgetScene(0.0004);
    scene.fixtures = {forbiddenClass("left", 0.02), forbiddenClass("all", 0.01), guidanceClass("goal"),
                      forbiddenClass("right", 0.035)};
    scene.fixtures[0].box = Box{{-1, -1, 0}, {0.05, 1, 3}};
    scene.fixtures[3].box = Box{{0.0, -0.05, 0}, {1, 0.1, 3}};
    CloudRig rig(scene, camera);
    rig.run(drawnImage(camera, [](int u, int v) {
        return u % 37 == 5 && v % 11 == 3 ? 0.0 : 0.6 + 0.0005 * u + 0.005 * std::sin(v * 0.05);
    }));
    const Thinned k = checkCoverage(rig, 20000);
    CHECK(k.coverage.holes == 0);
    CHECK(k.largestGrowth <= 0.0004 + 1e-8);
    CHECK(k.share() < 0.7);
    CHECK(verify::thinAgreement(rig).wrong == 0);
}

TEST_CASE("On a plane without noise thinning keeps about a sixteenth of the points, and all of them with "
          "budget 0") {
    const CameraInfo camera = longLens(320, 240);
    for (const double angle : {0.0, 30.0, 50.0}) {
        CAPTURE(angle);
        const dvec3 normal(std::sin(angle * 0.0174532925), 0.0, std::cos(angle * 0.0174532925));
        const Image plane = drawnImage(
            camera, [&](int u, int v) { return planeDepth(camera, u, v, normal, 0.5 * normal.z); });
        CloudRig thinned(budgetScene(0.0005), camera), whole(budgetScene(0.0), camera);
        const FrameReport few = thinned.run(plane), all = whole.run(plane);
        CHECK(all.counts.spheres == all.counts.forbidden);
        CHECK_FALSE(static_cast<bool>(whole.cycle().work().growth));
        const double share = static_cast<double>(few.counts.spheres) / all.counts.spheres;
        MESSAGE(angle, " degrees: ", share * 100.0, " % kept");
        CHECK(share < 0.12);
        CHECK(share > 1.0 / 16.0);
        CHECK(checkCoverage(thinned, 4000).coverage.holes == 0);
    }
}

TEST_CASE("A point whose cell is not full of its class is kept at edges, holes and steps") {
    const CameraInfo camera = longLens(48, 48);
    const auto depth = [](int u, int v) { return u == 21 && v == 21 ? 0.0 : u >= 30 ? 0.9 : 0.6; };
    CloudRig rig(budgetScene(0.0002), camera);
    rig.run(drawnImage(camera, depth));
    const auto kept = rig.spheres();
    const auto has = [&](int u, int v) { return kept[static_cast<size_t>(v * 48 + u)].radius >= 0.0; };
    for (int k = 0; k < 48; ++k) {
        CHECK(has(47, k)); // right and lower border: there is no next cell
        CHECK(has(k, 47));
        CHECK(has(28, k)); // the 2x2 cells that the step runs through
        CHECK(has(29, k));
    }
    for (const auto& [u, v] : {std::pair{20, 20}, {22, 20}, {20, 22}, {22, 22}, {20, 21}, {21, 20}}) {
        CHECK(has(u, v)); // around the hole
    }
    CHECK_FALSE(has(21, 21));
    CHECK_FALSE(has(9, 9));
    CHECK(checkCoverage(rig, 4000).coverage.holes == 0);
}

TEST_CASE("The coverage oracle detects a region that shrank") {
    const CameraInfo camera = longLens(64, 64);
    CloudRig rig(budgetScene(0.0005), camera);
    rig.run(drawnImage(camera, [](int, int) { return 0.5; }));
    const auto all = reference::spheres(rig.scene(), rig.forbidden(), rig.points(), {});
    auto kept = rig.spheres();
    CHECK(reference::coverage(all, kept, 4000, kTolerance, 3).holes == 0);
    for (auto& s : kept) {
        s.radius = s.radius >= 0.0 ? 0.04 : -1.0; // without the growth
    }
    const reference::Coverage shrunk = reference::coverage(all, kept, 4000, kTolerance, 3);
    CHECK(shrunk.holes > 100);
    CHECK(shrunk.worst > 1e-6);
}
