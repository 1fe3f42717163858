// SPDX-License-Identifier: Apache-2.0
// Group rotation: half turns, full turns, fast spins, guidance without roll, levers. The device cases are in
// rotation_device_cases.cpp.
#include "apps/stability/case_text.h"
#include "apps/stability/pressing.h"
#include "apps/stability/step_timer.h"
#include "engine/reference/rng.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::stability {

namespace {

Shape axisShape() {
    Shape shape = lineShape({0.0, 0.0, 1.0});
    shape.kind = ShapeKind::Axis; // keeps the tool's z axis on z, so any tilt of the hand gives torque
    return shape;
}

Pose turned(const dvec3& rotation) {
    return {dvec3(0.0), rotationExp(rotation)};
}

// Slowly past the half turn and back, about axes perpendicular to the constrained one.
Outcome halfTurn(RunLength runLength) {
    double step = 0.0, torque = 0.0, allowed = 1.0;
    bool sound = true;
    const int ticks = runLength == RunLength::Full ? 20000 : 4000;
    for (const double heading : {0.0, 0.7, 2.9}) {
        const Shape axis = axisShape();
        StepTimer stepTimer("ideal", true, {&axis, 1}, {});
        allowed = stepTimer.options().slewTorque * stepTimer.options().period;
        const dvec3 about(std::cos(heading), std::sin(heading), 0.0);
        dvec3 before(0.0);
        for (int i = 0; i < ticks; ++i) {
            const double angle = std::numbers::pi *
                                 (1.0 + 0.06 * std::sin(40.0 * std::numbers::pi * i / ticks)) *
                                 std::min(1.0, 4.0 * i / ticks);
            const StepRecord& record = stepTimer.step(turned(angle * about));
            step = std::max(step, glm::distance(record.wrench.torque, before));
            torque = std::max(torque, glm::length(record.wrench.torque));
            sound = sound && record.finite && std::abs(glm::length(record.tool.rotation) - 1.0) < 1e-12;
            before = record.wrench.torque;
        }
    }
    Outcome out =
        outcomeOf(step / allowed, 1.0 + 1e-9, "1",
                  "The hand swings through the half turn against a held axis, 30 crossings about three axes: "
                  "largest step of the torque over the "
                  "slew limit of a tick. The shortest arc changes sides there; the largest torque was " +
                      num(torque) + " N m.");
    require(out, sound && torque <= 2.0 + 1e-9,
            "finite numbers, a unit quaternion and at most 2 N m were expected");
    return out;
}

// Full turns: past the half turn, the spring returns the energy that it stored.
Outcome wholeTurns(RunLength runLength) {
    const int ticks = runLength == RunLength::Full ? 40000 : 8000;
    double drawn = -1e9, stored = 1.0;
    for (const double heading : {0.0, 1.1, 2.5}) {
        const Shape axis = axisShape();
        StepTimer stepTimer("ideal", false, {&axis, 1}, {});
        for (int i = 0; i < 300; ++i) {
            stepTimer.step({}); // ramp
        }
        const dvec3 about(std::cos(heading), std::sin(heading), 0.0);
        dvec3 before(0.0);
        double work = 0.0;
        for (int i = 1; i <= ticks; ++i) {
            const StepRecord& record = stepTimer.step(turned(2.0 * std::numbers::pi * i / ticks * about));
            work += glm::dot(0.5 * (record.wrench.torque + before), 2.0 * std::numbers::pi / ticks * about);
            before = record.wrench.torque;
        }
        stored = 0.5 * stepTimer.options().springs.rotationalStiffness * std::numbers::pi * std::numbers::pi;
        drawn = std::max(drawn, work);
    }
    return outcomeOf(drawn / stored, 1e-3, "1",
                     "Whole turns of the hand against a held axis: work gained per turn, divided by the "
                     "spring's energy at the half turn (" +
                         num(stored) + " J); the rest comes from the change of sides between two ticks.");
}

// Guidance without a roll target gives no torque about the axis that it aligns, for any orientation of the
// hand.
Outcome noRoll(RunLength runLength) {
    double worst = 0.0, felt = 0.0;
    Rng rng(8);
    const int hands = runLength == RunLength::Full ? 60 : 10;
    for (int n = 0; n < hands; ++n) {
        GuidancePose target;
        target.present = target.planar = target.rollFree = true;
        target.target = {dvec3(0.0), rng.rotation()};
        Pose hand{dvec3(0.0), rng.rotation()};
        if (n % 5 == 0) { // points in the opposite direction
            hand.rotation = target.target.rotation * rotationExp({std::numbers::pi, 0.0, 0.0});
        }
        StepTimer stepTimer("ideal", true, {}, hand);
        stepTimer.guidance = {target};
        const dvec3 aimed = target.target.rotation * dvec3(0.0, 0.0, 1.0);
        for (int i = 0; i < 800; ++i) {
            const StepRecord& record = stepTimer.step(hand);
            worst = std::max(worst, std::abs(glm::dot(record.wrench.torque, aimed)));
            felt = std::max(felt, glm::length(record.wrench.torque));
        }
    }
    Outcome out = outcomeOf(worst, 1e-9, "N m",
                            "A guidance target without roll, hands that point anywhere, one in five exactly "
                            "the other way: largest torque about the axis of the target; across it " +
                                num(felt) + " N m (0.1 is the limit).");
    require(out, felt > 0.09 && felt < 0.1001, "guidance should pull with 0.1 N m");
    return out;
}

// Twenty revolutions per second with a tool that has no room to rotate.
Outcome fastSpin(RunLength runLength) {
    double norm = 0.0, step = 0.0;
    bool sound = true;
    const Shape axis = axisShape();
    StepTimer stepTimer("ideal", true, {&axis, 1}, {});
    const double allowed = stepTimer.options().slewTorque * stepTimer.options().period;
    dvec3 before(0.0);
    Rng rng(5);
    dvec3 about = rng.direction();
    dquat hand(1.0, 0.0, 0.0, 0.0);
    for (int i = 0; i < (runLength == RunLength::Full ? 100000 : 10000); ++i) {
        about = i % 500 == 0 ? rng.direction() : about;
        hand = glm::normalize(rotationExp(40.0 * std::numbers::pi * 0.001 * about) * hand);
        const StepRecord& record = stepTimer.step({dvec3(0.0), hand});
        norm = std::max({norm, std::abs(glm::length(record.tool.rotation) - 1.0),
                         std::abs(glm::length(record.device.rotation) - 1.0)});
        step = std::max(step, glm::distance(record.wrench.torque, before) / allowed);
        sound = sound && record.finite;
        before = record.wrench.torque;
    }
    Outcome out = outcomeOf(step, 1.0 + 1e-9, "1",
                            "A hand that spins 20 times per second, about another axis every half second, "
                            "against a held axis: largest torque step over the slew "
                            "limit; quaternions off unit length by at most " +
                                num(norm) + ".");
    require(out, sound && norm < 1e-14, "finite numbers and unit quaternions were expected");
    return out;
}

// Lever: a cross of balls pressed at a tilt, with the loop closed in all six degrees of freedom.
Outcome leverSettles(RunLength runLength) {
    double worst = 0.0;
    LoopGrid grid;
    grid.masses = {0.1, 0.5};
    grid.every = runLength == RunLength::Full ? 1 : 7;
    LoopSpec base = pressedSpec(Ground::Wall, kPressed);
    base.leaves = crossLeaves(0.008);
    for (HandWaypoint& way : base.path) {
        way.deviceThandle.position.z += 0.05;
        way.deviceThandle.rotation = rotationExp({2.0, 0.3, 0.0});
    }
    const size_t runs = forEachLoop(grid, base, [&](LoopSpec spec) {
        const double window =
            std::max(0.3, 3.0 * std::numbers::pi / std::sqrt(spec.hand.stiffness / spec.wholeMass()));
        spec.path.back().t = kPressed + 2.0 * window;
        LoopRig rig(spec);
        rig.run(kPressed);
        double early = 1e-4, late = 0.0;
        while (rig.time() < kPressed + 2.0 * window) {
            rig.tick();
            double& peak = rig.time() < kPressed + window ? early : late;
            peak = std::max(peak, glm::length(rig.hand().spin()));
        }
        worst = std::max(worst, late / early);
    });
    return outcomeOf(worst, 0.9, "1",
                     "A tilted cross of nine balls pressed into a wall, closed loop in all six axes: fastest "
                     "spin of the hand late in the run divided by early, worst of " +
                         num(uint64_t{runs}) + " loops with the automatic stiffness.");
}

} // namespace

std::vector<Case> rotationCases() {
    std::vector<Case> all{{"half-turn-against-a-held-axis", Group::Rotation, halfTurn},
                          {"whole-turns-draw-no-energy", Group::Rotation, wholeTurns},
                          {"guidance-without-roll", Group::Rotation, noRoll},
                          {"twenty-turns-a-second", Group::Rotation, fastSpin},
                          {"lever-settles", Group::Rotation, leverSettles}};
    for (Case& one : rotationDeviceCases()) {
        all.push_back(std::move(one));
    }
    return all;
}

} // namespace fathom::stability
