// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/geometry_truth.h"

#include "apps/stability/case_text.h"
#include "apps/stability/escape_run.h"
#include "apps/stability/hand_run.h"
#include "apps/stability/image_fixtures.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kBall = 0.01;     // [m] radius of the tool
constexpr double kUnit = 0.0001;   // [m] depth unit of the image
constexpr double kBudget = 0.0001; // [m] error budget of thinning

struct TruthImage {
    AnalyticScene scene;
    HostFixtures set;
};

TruthImage imageOf(AnalyticScene scene, double radius, double edge, uint32_t width) {
    SimulatedCameraOptions options;
    options.width = width;
    options.height = width * 3 / 4;
    options.metresPerUnit = kUnit;
    options.noise = options.water = options.motion = false;
    SimulatedCamera camera(scene, options);
    Scene red = redScene(radius);
    red.filter.radius = 0;
    red.filter.edge = edge;
    ImageFixtures make(red, camera.info(), false);
    return {std::move(scene), make.make(*camera.next().value())};
}

// Pressed onto a ball from many directions on the camera's side, the tool rests on the surface of the region.
Outcome ballTruthCase(RunLength runLength) {
    const double region = 0.04;
    const TruthImage p = imageOf(analyticScene("sphere").value(), region, 0.03, 320);
    const dvec3 centre(0.0, 0.0, 0.7);
    const double wanted = 0.1 + region + kBall;
    double above = 0.0, below = 0.0;
    Rng rng(11);
    const int trials = some(runLength, 500, 40);
    for (int i = 0; i < trials; ++i) {
        dvec3 way = rng.direction();
        way = glm::normalize(dvec3(way.x, way.y, -std::abs(way.z) - 0.7)); // well within the visible side
        LockstepRig rig(ballTool(kBall), {centre + (wanted + 0.004) * way, kUpright});
        rig.show(p.set);
        for (int k = 0; k < 120; ++k) {
            rig.step({centre + (wanted - 0.005) * way, kUpright});
        }
        const double off = glm::distance(rig.pose().position, centre) - wanted;
        above = std::max(above, off);
        below = std::max(below, -off);
    }
    // Sum of one depth unit of rounding, the growth budget of the regions, and the dimples between kept
    // points.
    const double limit = kUnit + 2.0 * kBudget;
    Outcome out = outcomeOf(
        std::max(above, below), limit, "m",
        "Distance of the resting tool from the exact skin of a ball of 0.1 m with regions of 40 mm; " +
            num(uint64_t(trials)) + " directions, up to " + num(above) + " m above and " + num(below) +
            " m below. Limit: a depth unit, the growth and the dimple that the error budget allows.");
    return out;
}

// A plane tilted by `degrees` from face-on. At a point spacing of s, the tool may sink into the dimple
// between points, but no deeper than sqrt((R + r)^2 - s^2 / 2).
Outcome grazingCase(RunLength runLength) {
    double worst = 0.0, spacing = 0.0;
    Rng rng(12);
    for (const double degrees : {60.0, 75.0, 82.0, 86.0}) {
        const double tilt = degrees * kDegree;
        AnalyticScene scene;
        scene.name = "grazing";
        scene.objects = {"surroundings", "red"};
        const dvec3 point(0, 0, 0.6), normal(0.0, std::sin(tilt), -std::cos(tilt));
        scene.solids.push_back(planeThrough(point, normal, {linearColour(200, 36, 32), 0.1f, 0.0f}));
        scene.solids.back().object = 1;
        const double region = 0.03;
        const TruthImage p = imageOf(scene, region, 0.0, 320);
        const int trials = some(runLength, 100, 6);
        for (int i = 0; i < trials; ++i) {
            const dvec3 along(0.0, std::cos(tilt), std::sin(tilt));
            const dvec3 foot =
                point + rng.uniform(-0.03, 0.03) * dvec3(1, 0, 0) + rng.uniform(-0.1, 0.1) * along;
            LockstepRig rig(ballTool(kBall), {foot + (region + kBall + 0.003) * normal, kUpright});
            rig.show(p.set);
            for (int k = 0; k < 150; ++k) {
                rig.step({foot - 0.02 * normal, kUpright});
            }
            const double z = rig.pose().position.z, pixel = z * (1.0 + 0.15) / (570.0 / 640.0 * 320.0);
            const double s2 = pixel * pixel * (1.0 + 1.0 / (std::cos(tilt) * std::cos(tilt)));
            spacing = std::max(spacing, std::sqrt(s2));
            const double skin = std::sqrt(std::max(0.0, (region + kBall) * (region + kBall) - 0.5 * s2));
            worst = std::max(worst, skin - glm::dot(rig.pose().position - point, normal));
        }
    }
    return outcomeOf(worst, kUnit + kBudget, "m",
                     "How much deeper than sqrt((R + r)^2 - s^2/2) the tool sinks between points s apart on "
                     "a plane seen at 60 to 86 "
                     "degrees from face-on; s up to " +
                         num(spacing) + " m. Limit: a depth unit and the error budget.");
}

// The hand moves straight through a plate 2 mm thick with regions of 10 mm radius.
Outcome plateCase(RunLength runLength) {
    const TruthImage p = imageOf(analyticScene("plate").value(), 0.01, 0.03, 320);
    const Solid& plate = p.scene.solids.front();
    double worst = -1.0;
    HandRunFigures all;
    Rng rng(13);
    const int trials = some(runLength, 300, 15);
    for (int i = 0; i < trials; ++i) {
        const double speed = rng.logUniform(0.05, 5.0);
        const dvec3 through = glm::transpose(plate.localTscene) *
                                  dvec3(rng.uniform(-0.08, 0.08), rng.uniform(-0.07, 0.07), 0.0) +
                              plate.position;
        const dvec3 way = glm::normalize(through + 0.1 * rng.direction());
        const dvec3 start = through - 0.06 * way;
        LockstepRig rig(ballTool(kBall), {start, kUpright});
        rig.show(p.set);
        rig.faults = {static_cast<uint32_t>(rng.below(20)), false, 0.1};
        const double reach = std::min(0.12, 0.6 * speed);
        for (double s = 0.0; s < reach; s += speed * 0.001) {
            const StepRecord record = rig.step({start + s * way, kUpright});
            worst = std::max(worst, kBall - signedDistance(plate, record.tool.position));
        }
        all.add(rig);
    }
    Outcome out = outcomeOf(worst, 0.0, "m",
                            "Deepest entry into the exact plate of 2 mm (negative: always clear of it) by "
                            "hands that go through it at "
                            "0.05 to 5 m/s with answers late by up to 20 ms. " +
                                all.words());
    require(out, all.penetration <= 1e-9, "a region was entered");
    require(out, all.rig.contact > 0, "the tool never touched");
    return out;
}

// The tool is pressed into tight places. Measures how far it still moves after the hand has been still for a
// while.
Outcome restCase(RunLength runLength, const std::vector<World>& worlds, const std::string& what) {
    double jitter = 0.0;
    HandRunFigures all;
    Rng rng(14);
    for (const World& world : worlds) {
        const int trials = some(runLength, 40, 4);
        for (int i = 0; i < trials; ++i) {
            LockstepRig rig(toolOf(world.leaves), world.start);
            rig.show(world.fixtures);
            const Pose hand{world.focus + 0.02 * rng.direction() +
                                0.05 * glm::normalize(world.focus - world.start.position),
                            rotationExp(0.3 * rng.direction())};
            for (int k = 0; k < 1500; ++k) {
                const dvec3 before = rig.pose().position;
                rig.step(hand);
                jitter = k >= 1400 ? std::max(jitter, glm::distance(before, rig.pose().position)) : jitter;
            }
            all.add(rig);
        }
    }
    Outcome out = outcomeOf(jitter, 1e-6, "m",
                            "Largest motion per tick after 1.4 s of pressing: " + what + " " + all.words());
    require(out, all.penetration <= 1e-9, "a region was entered");
    require(out, all.rig.contact > 0, "the tool never touched");
    return out;
}

// Leaf, sphere and camera coincide.
Outcome cameraOriginCase(RunLength runLength) {
    Rng rng(15);
    EscapeTotals totals;
    const int trials = some(runLength, 500, 40);
    for (int i = 0; i < trials; ++i) {
        const double radius = rng.logUniform(0.001, 0.05);
        const Pose start{dvec3(0.0, 0.0, i % 3 == 0 ? 0.0 : -rng.logUniform(1e-12, 1e-6)), kUpright};
        LockstepRig rig(ballTool(kBall), start);
        const auto withImage = [](HostFixtures set, uint16_t depth) {
            set.camera.depth.width = 16;
            set.camera.depth.height = 12;
            set.camera.depth.fx = set.camera.depth.fy = 14.0;
            set.camera.depth.cx = 7.5;
            set.camera.depth.cy = 5.5;
            set.depth.assign(192, depth);
            set.forbiddenBits.assign(6, ~0u);
            return set;
        };
        HostFixtures first, second;
        first.spheres.add(dvec3(10, 0, 0), radius);
        for (int k = 0; k < 1 + i % 5; ++k) { // on one side, so that there is a way out
            const dvec3 off = k == 0 ? dvec3(0.0) : glm::normalize(rng.direction() + dvec3(0, 0, 1.5));
            second.spheres.add(1e-3 * radius * off, radius);
        }
        rig.show(withImage(std::move(first), 500));
        rig.step(start);
        rig.show(withImage(std::move(second), static_cast<uint16_t>(i % 2)));
        totals.add(escape(rig, start, 400), std::ceil((radius + kBall) / 1e-3) + 2.0, rig);
    }
    Outcome out = outcomeOf(
        totals.worst, 1.0, "1",
        "Ticks until out over (R + r) / 1 mm and two: up to five spheres within 1e-3 R of the camera's own "
        "centre, the leaf there too, " +
            num(uint64_t(trials)) + " trials.");
    totals.requireGood(out, 1e-9);
    return out;
}

World tightSlot() { // 2 mm too narrow
    World w = slotWorld();
    w.name = "tight slot";
    w.leaves = {{dvec3(0.0), 0.012}};
    w.start = {dvec3(0.17, 0, 0), kUpright};
    w.focus = dvec3(0.0);
    return w;
}

} // namespace

void addTruthCases(std::vector<Case>& cases) {
    const auto put = [&](const char* name, std::function<Outcome(RunLength)> run) {
        cases.push_back({std::string("geometry-") + name, Group::Geometry, std::move(run)});
    };
    put("ball-skin", ballTruthCase);
    put("grazing-rays", grazingCase);
    put("thin-plate", plateCase);
    put("camera-origin", cameraOriginCase);
    put("rest-in-narrow-slot",
        [](RunLength e) { return restCase(e, {tightSlot()}, "slot 2 mm narrower than the tool."); });
    put("rest-in-groove", [](RunLength e) {
        return restCase(e, {grooveWorld(5.0), grooveWorld(20.0), grooveWorld(60.0)},
                        "grooves of 5, 20 and 60 degrees.");
    });
    put("rest-in-corner", [](RunLength e) { return restCase(e, {cornerWorld()}, "corner of three walls."); });
}

} // namespace fathom::stability
