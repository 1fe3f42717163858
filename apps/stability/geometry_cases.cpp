// SPDX-License-Identifier: Apache-2.0
// Group geometry: degenerate contacts, extreme sizes and extreme positions.
#include "apps/stability/case_text.h"
#include "apps/stability/escape_run.h"
#include "apps/stability/geometry_truth.h"
#include "apps/stability/hand_run.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kNanometre = 1e-9;     // [m] penetration limit: zero plus the rounding error of the audit
constexpr double kEscapePerTick = 1e-3; // [m] depth removed per tick

HostFixtures oneSphere(const dvec3& centre, double radius) {
    HostFixtures set;
    set.spheres.add(centre, radius);
    return set;
}

// New data puts a sphere's centre exactly or almost on a leaf's centre, so no direction points out.
Outcome coincidingCase(RunLength runLength) {
    Rng rng(1);
    EscapeTotals totals;
    const int trials = some(runLength, 2000, 80);
    for (int i = 0; i < trials; ++i) {
        const double radius = rng.logUniform(0.001, 0.05), leaf = rng.logUniform(0.001, 0.02);
        const dvec3 at(std::floor(rng.uniform(-100.0, 100.0)) / 128.0, 0.25, 0.5); // exact in float32
        const double off = i % 4 == 0 ? 0.0 : std::pow(10.0, -300.0 + 291.0 * rng.uniform(0.0, 1.0));
        const Pose start{at + off * rng.direction(), kUpright};
        LockstepRig rig(ballTool(leaf), start);
        rig.show(oneSphere(at + dvec3(10, 0, 0), radius));
        rig.step(start);
        rig.show(oneSphere(at, radius));
        totals.add(escape(rig, start, 400), std::ceil((radius + leaf) / kEscapePerTick) + 1.0, rig);
    }
    Outcome out = outcomeOf(
        totals.worst, 1.0, "1",
        "Ticks until the tool is out over (R + r) / 1 mm, rounded up, and one: sphere centre at the leaf's "
        "centre, off by 0 or 1e-300 to 1e-9 m, " +
            num(uint64_t(trials)) + " trials.");
    totals.requireGood(out, kNanometre);
    return out;
}

// The gap is exactly 0 in float64, and the hand pushes in every direction.
Outcome zeroGapCase(RunLength runLength) {
    Rng rng(2);
    HandRunFigures all;
    uint64_t exact = 0;
    const int trials = some(runLength, 4000, 150);
    for (int i = 0; i < trials; ++i) {
        const double radius = std::exp2(-static_cast<double>(3 + rng.below(5))), leaf = std::exp2(-7.0);
        dvec3 centre = (radius + leaf) * rng.direction();
        if (i % 2 == 0) {
            centre = dvec3(0.0);
            centre[static_cast<int>(rng.below(3))] = radius + leaf;
        }
        exact += glm::length(centre) - (radius + leaf) == 0.0 ? 1 : 0;
        LockstepRig rig(ballTool(leaf), {centre, kUpright});
        rig.show(oneSphere(dvec3(0.0), radius));
        for (int k = 0; k < 12; ++k) {
            rig.step({centre - rng.logUniform(1e-9, 1.0) * glm::normalize(centre + 0.1 * rng.direction()),
                      rng.rotation()});
        }
        all.add(rig);
    }
    return penetrationOutcome(all, kNanometre,
                              num(exact) + " starts with a gap of exactly 0, the others within rounding. ");
}

// The leaf is deep inside hundreds of spheres whose centres are all on one side, so there is a way out.
Outcome insideManyCase(RunLength runLength) {
    Rng rng(3);
    double worst = 0.0, growth = 0.0;
    uint64_t stuck = 0;
    const int trials = some(runLength, 400, 20);
    for (int i = 0; i < trials; ++i) {
        const double radius = rng.uniform(0.02, 0.05);
        const dvec3 up = rng.direction();
        HostFixtures set;
        for (int k = 0; k < 800; ++k) {
            const dvec3 about = 0.5 * radius * rng.direction();
            set.spheres.add(about - (std::max(0.0, glm::dot(about, up)) + 0.006) * up,
                            radius); // below every leaf
        }
        const Pose start{dvec3(0.0), rng.rotation()};
        LockstepRig rig(
            toolOf({{dvec3(0.0), 0.01}, {dvec3(0, 0, 0.005), 0.008}, {dvec3(0.005, 0, 0), 0.006}}), start);
        rig.show(oneSphere(dvec3(10, 0, 0), radius));
        rig.step(start);
        rig.show(std::move(set));
        const EscapeFigures f = escape(rig, start, 1000);
        // The longest way out of the union is along `up`: a travel of at most R + r + leaf offset.
        worst = std::max(worst, f.ticks * kEscapePerTick / (radius + 0.02 + 0.005));
        growth = std::max({growth, f.growth, rig.audit().maxPenetration()});
        stuck += f.out ? 0 : 1;
    }
    Outcome out = outcomeOf(
        worst, 1.2, "1",
        "Ticks x 1 mm until three leaves inside 800 spheres are out, divided by the straight distance; " +
            num(uint64_t(trials)) +
            " trials. The limit allows paths that are a fifth longer, because they bend from dimple to "
            "dimple.");
    require(out, stuck == 0, num(stuck) + " never out");
    require(out, growth <= kNanometre, "a depth grew by " + num(growth) + " m");
    return out;
}

World radiiWorld() {
    World w = wallWorld();
    w.name = "radii";
    w.fixtures = {};
    Rng rng(4);
    for (int k = 0; k < 3000; ++k) {
        const double radius = rng.logUniform(1e-4, 10.0);
        const dvec3 way = rng.direction();
        w.fixtures.spheres.add(way * (radius + rng.uniform(0.1, 0.2)), radius); // near the arena
    }
    w.leaves = crossLeaves(0.004);
    w.start = {dvec3(0.0), kUpright};
    return w;
}

World equalsWorld() {
    World w = wallWorld();
    w.name = "equals";
    w.fixtures = {};
    for (const dvec3& at : {dvec3(0.02, 0, 0), dvec3(-0.03, 0.01, 0), dvec3(0, 0, -0.04)}) {
        for (int k = 0; k < 1000; ++k) {
            w.fixtures.spheres.add(at, 0.02);
        }
    }
    w.arena = 0.08;
    return w;
}

World giantToolWorld() {
    World w = wallWorld();
    w.name = "giant tool";
    w.leaves.clear();
    for (int k = -50; k <= 50; ++k) {
        w.leaves.push_back({dvec3(0.1 * k, 0, 0), 0.06});
    }
    w.start = {dvec3(0, 0, 0.13), kUpright};
    return w;
}

World tinyToolWorld() {
    World w = wallWorld();
    w.name = "tiny tool";
    w.leaves = {{dvec3(0.0), 1e-6}, {dvec3(0, 0, 1e-3), 1e-5}, {dvec3(1e-3, 0, 0), 1e-4}};
    return w;
}

World plateOfLeavesWorld() {
    World w = wallWorld();
    w.name = "thousand leaves";
    w.leaves.clear();
    for (int i = 0; i < 32; ++i) {
        for (int j = 0; j < 32; ++j) {
            w.leaves.push_back({dvec3(0.006 * (i - 15.5), 0.006 * (j - 15.5), 0.0), 0.005});
        }
    }
    return w;
}

Outcome handRuns(const World& world, RunLength runLength, int full, const std::string& what,
                 const RigSetup& setup = {}) {
    HandRunFigures all;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        HandRun handRun;
        handRun.ticks = some(runLength, full, std::max(60, full / 50));
        handRun.seed = seed;
        handRun.setup = setup;
        handRun.motion.speed = seed == 3 ? 5.0 : 0.3;
        handRun.faults.late = seed == 2 ? 5 : 0;
        runHand(world, handRun, all);
    }
    return penetrationOutcome(all, kNanometre, what + " ");
}

// The same run at the base origin and far from it. Positions are relative to a local origin, so only rounding
// may differ.
Outcome farCase(RunLength runLength, double distance) {
    const World near = rubbleWorld();
    const dvec3 way = distance * glm::normalize(dvec3(0.6, -0.5, 0.62));
    const World far = movedBy(near, way);
    LockstepRig a(toolOf(near.leaves), near.start), b(toolOf(far.leaves), far.start);
    a.show(near.fixtures);
    b.show(far.fixtures);
    RandomHand hand(near.start, near.focus, near.arena, {0.3, 3.0, 0.0, 0.0, 0.0, 0.0}, 5);
    double apart = 0.0;
    const int ticks = some(runLength, 20000, 1000);
    Outcome::Curve curve{"difference of the tool's path", "tick", "difference [m]", {}, {}, false, true};
    for (int k = 0; k < ticks; ++k) {
        const Pose wanted = hand.next(0.001);
        const dvec3 here = a.step(wanted).tool.position;
        const dvec3 there = b.step({wanted.position + way, wanted.rotation}).tool.position - way;
        apart = std::max(apart, glm::distance(here, there));
        if (k % (ticks / 200) == 0) {
            curve.x.push_back(k);
            curve.y.push_back(std::max(glm::distance(here, there), 1e-17));
        }
    }
    // Contact on rubble is chaotic: a rounding difference may lead to the other side of a ball. The rounding
    // error itself is eps x distance.
    Outcome out = outcomeOf(
        b.audit().maxPenetration(), kNanometre, "m",
        "Deepest penetration beyond the allowance in rubble " + num(distance / 1000.0) +
            " km from the base origin over " + num(uint64_t(ticks)) + " ticks, " + num(b.figures.contact) +
            " in contact; the path differs from the same run at the origin by at most " + num(apart) +
            " m (rounding of the base frame is " + num(distance * 2.2e-16) + " m).");
    require(out, b.figures.contact > 0, "the tool never touched");
    require(out, apart <= 5e-3, "the ways part by more than 5 mm");
    out.curves.push_back(std::move(curve));
    return out;
}

} // namespace

std::vector<Case> geometryCases() {
    std::vector<Case> cases;
    const auto put = [&](const char* name, std::function<Outcome(RunLength)> run) {
        cases.push_back({std::string("geometry-") + name, Group::Geometry, std::move(run)});
    };
    put("coinciding-centres", coincidingCase);
    put("gap-of-zero", zeroGapCase);
    put("inside-many-spheres", insideManyCase);
    put("radii-01mm-to-10m", [](RunLength e) {
        return handRuns(radiiWorld(), e, 8000, "3000 spheres of 0.1 mm to 10 m in one scene.");
    });
    put("thousand-equal-spheres", [](RunLength e) {
        return handRuns(equalsWorld(), e, 20000, "Three bundles of 1000 equal spheres.");
    });
    put("needle", [](RunLength e) {
        return handRuns(needleWorld(), e, 40000, "Spikes of 0.1 and 0.2 mm, tool of 0.5 mm, steps of 2 mm.");
    });
    put("tool-10m", [](RunLength e) {
        return handRuns(giantToolWorld(), e, 4000, "Tool of 10 m, 101 leaves: rotation sweeps arcs.");
    });
    put("tool-1mm", [](RunLength e) {
        return handRuns(tinyToolWorld(), e, 20000, "Tool of 1 mm with leaves of 1 um to 0.1 mm.");
    });
    put("thousand-leaves", [](RunLength e) {
        return handRuns(plateOfLeavesWorld(), e, 2000,
                        "1024 leaves flat on a wall: more contacts than rows.");
    });
    put("overflowing-answers", [](RunLength e) {
        return handRuns(
            rubbleWorld(), e, 6000,
            "Contact sets with room for 64 spheres and 256 pairs at first: the reach shrinks instead.",
            {0.05, {64, 256}});
    });
    put("origin-1km", [](RunLength e) { return farCase(e, 1e3); });
    put("origin-100km", [](RunLength e) { return farCase(e, 1e5); });
    addTruthCases(cases);
    return cases;
}

} // namespace fathom::stability
