// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/feel_loops.h"

#include "apps/stability/case_text.h"
#include "apps/stability/feel_rig.h"
#include "apps/stability/wall_camera.h"
#include "apps/stability/worlds.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

struct FeltHand {
    const char* name;
    HandLoop loop; // mass [kg], damping [N s/m], stiffness [N/m] of hand and device
};
constexpr std::array<FeltHand, 3> kFeltHands{
    {{"light", {0.1, 0.5, 100.0}}, {"default", {0.2, 1.0, 300.0}}, {"firm", {0.3, 6.0, 400.0}}}};

FeelRig pressedHand(FeelSpec spec, const HandLoop& loop, double depth) {
    spec.loop = loop;
    FeelRig felt(spec);
    const Pose above = felt.at(0.01, 0.02, -0.02);
    const Pose pressed = felt.at(0.01, 0.02, depth);
    felt.follow({{0.0, above, 0}, {0.2, above, 0}, {0.6, pressed, 0}});
    felt.run(0.6);
    return felt;
}

// The light hand, whose own damping is all that the stiffness relies on, at rest on a clean wall.
Outcome restCase(const FeltHand& hand, double after, double limit) {
    FeelSpec spec;
    spec.scene = "wall";
    spec.noise = false;
    spec.ball = true;
    FeelRig felt = pressedHand(spec, hand.loop, 0.02);
    felt.run(after);
    felt.forget();
    felt.run(0.5);
    Outcome out =
        outcomeOf(felt.trace().motionPeakToPeak(), limit, "m",
                  std::string("Peak-to-peak motion of a ") + hand.name + " hand within 0.5 s, from " +
                      num(after) + " s after it has pressed onto a clean wall. Stiffness " +
                      num(felt.options().springs.stiffness) + " N/m.");
    require(out, felt.rig().audit().maxPenetration() <= 1e-9, "a leaf entered a region");
    require(out, glm::length(felt.last().wrench.force) > 0.2, "no force at the end");
    return out;
}

// The same hands at a noisy wall: how much the noise moves them where it is felt as vibration.
Outcome shakeCase(RunLength runLength, const FeltHand& hand, double limit) {
    FeelSpec spec;
    spec.scene = "wall";
    FeelRig felt = pressedHand(spec, hand.loop, 0.02);
    felt.run(0.8);
    felt.forget();
    felt.run(some(runLength, 4, 1));
    Outcome out =
        outcomeOf(felt.trace().motionBand(10.0, 35.0), limit, "m",
                  std::string("Motion in 10 to 35 Hz of a ") + hand.name +
                      " hand that rests on a noisy wall; force RMS " + num(felt.trace().forceRms()) + " N.");
    require(out, felt.rig().audit().maxPenetration() <= 1e-9, "a leaf entered a region");
    require(out, glm::length(felt.last().wrench.force) > 0.2, "no force at the end");
    return out;
}

// Where the scene gives K, 1 mm of the hand changes the force by K x 1 mm.
Outcome stiffnessCase(RunLength) {
    FeelSpec spec;
    spec.scene = "wall";
    spec.noise = false;
    spec.haptics.stiffness = 800.0;
    FeelRig felt(spec);
    const dvec3 normal = dvec3(0.0, 0.0, -1.0);
    std::array<double, 2> force{};
    const Pose shallow = felt.at(0.01, 0.02, 0.004), above = felt.at(0.01, 0.02, -0.02);
    const Pose deep{shallow.position - 0.008 * normal, shallow.rotation};
    felt.follow({{0.0, above, 0}, {0.4, shallow, 0}, {1.0, shallow, 0}, {1.1, deep, 0}});
    felt.run(0.9);
    force[0] = glm::dot(felt.last().wrench.force, normal);
    felt.run(0.9);
    force[1] = glm::dot(felt.last().wrench.force, normal);
    const double wrong = std::abs((force[1] - force[0]) / (800.0 * 0.008) - 1.0);
    const double onset = std::abs(force[0] / 800.0 - 0.004 * std::abs(normal.z));
    Outcome out =
        outcomeOf(wrong, 0.05, "1",
                  "Felt stiffness of a clean wall over the 800 N/m of the scene, less one; the surface "
                  "is felt " +
                      num(1e3 * onset) + " mm from the true one.");
    require(out, onset <= 0.001, "the surface is felt in the wrong place");
    return out;
}

} // namespace

double approachRise(double speed, double reach, int trials) {
    constexpr double kFar = 0.6, kStand = WallCamera::kRegion + 0.01;
    double steepest = 0.0;
    for (int trial = 0; trial < trials; ++trial) {
        WallCamera camera(false, static_cast<uint64_t>(trial + 1));
        const Pose hand{dvec3(0.004, 0.003, kFar - kStand), kUpright};
        LockstepRig rig(ballTool(0.01), hand);
        FeltTrace trace;
        const double first = WallCamera::kFrame * trial / trials;
        const auto ticks = static_cast<int>((reach / speed + 0.4) * 1000.0);
        int frames = 0;
        for (int k = 0; k < ticks; ++k) {
            const double t = 0.001 * k;
            for (; frames * WallCamera::kFrame <= t; ++frames) {
                const double moved = std::clamp(speed * (t + first - 0.25), 0.0, reach);
                rig.show(camera.look({kFar - moved, 0.0, 0.0}));
            }
            trace.add(rig.step(hand).wrench, hand.position);
        }
        steepest = std::max(steepest, trace.steepestRise(0.001) / rig.options().springs.stiffness);
    }
    return steepest;
}

void addFeelLoops(std::vector<Case>& cases) {
    const auto put = [&](const std::string& name, std::function<Outcome(RunLength)> run) {
        cases.push_back({"feel-" + name, Group::Feel, std::move(run)});
    };
    for (const FeltHand& hand : kFeltHands) {
        const std::string name = hand.name;
        put(name + "-hand-rests-after-1s", [&hand](RunLength) { return restCase(hand, 1.0, 4e-4); });
        put(name + "-hand-rests-after-4s", [&hand](RunLength) { return restCase(hand, 4.0, 1e-5); });
        put(name + "-hand-on-noise", [&hand](RunLength e) { return shakeCase(e, hand, 1.5e-5); });
    }
    put("stiffness", stiffnessCase);
}

} // namespace fathom::stability
