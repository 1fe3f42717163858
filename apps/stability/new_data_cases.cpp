// SPDX-License-Identifier: Apache-2.0
// Group new-data: surfaces that jump or sweep over the tool, and how the tool gets out.
#include "apps/stability/new_data_streams.h"

#include "apps/stability/case_text.h"
#include "apps/stability/escape_run.h"
#include "apps/stability/wall_camera.h"
#include "apps/stability/worlds.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kDepthPerTick = 1e-3;                 // [m] depth removed per tick
constexpr double kTool = 0.01;                         // [m] radius of the tool's balls
constexpr double kStand = WallCamera::kRegion + kTool; // [m] distance from the wall at which the tool rests
constexpr double kWall = 0.5;                          // [m]
constexpr double kSweep = 0.25;                        // [m] that an approaching wall moves
constexpr double kExtraTicks =
    3.0; // on top of depth / 1 mm: the answer, the last fraction, sideways motion in dimples

// Measured: 0.72 N and 0.029 N m. The slew limiter alone would give 2 N and 0.05 N m.
constexpr double kMaxForceRise = 0.5;   // [N]
constexpr double kMaxTorqueRise = 0.03; // [N m] RMS

// Accepts poses on the camera's side of a wall at z [m].
std::function<bool(const Pose&)> inFrontOf(double z) {
    return [z](const Pose& pose) { return pose.position.z < z; };
}

struct JumpFigures {
    double ratio = 0.0;                       // ticks over the number expected at 1 mm per tick
    double growth = 0.0;                      // [m]
    double front = 1.0;                       // [m] smallest distance in front of the wall at the end
    double forceStep = 0.0;                   // [N]
    double forceRise = 0.0, torqueRise = 0.0; // largest [N], RMS [N m], after the jump
    uint64_t runs = 0, stuck = 0, flagged = 0;
    double ticks = 0.0; // largest of all runs
};

// The tool rests on the wall (pressed or not), then the wall jumps nearer by `jump` [m].
void jumpOnce(const Tool& tool, double jump, double noise, double press, uint32_t late, uint64_t seed,
              JumpFigures& f) {
    Rng rng(seed);
    WallCamera camera(false, seed);
    const dvec3 at(rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), kWall - kStand - 0.005);
    const Pose hand{at + dvec3(0, 0, press), rng.rotation()};
    const double back =
        tool.boundingRadius() - kTool; // the tool starts in front of the wall, whatever its leaves
    LockstepRig rig(tool, {at - dvec3(0, 0, back), hand.rotation});
    rig.faults.late = late;
    rig.show(camera.look({kWall, noise, 0.0}));
    for (uint32_t k = 0; k < 100 + 3 * late; ++k) {
        rig.step(hand);
    }
    const double resting = rig.pose().position.z;
    rig.figures.forceRise = rig.figures.torqueRise = {}; // the approach does not count
    rig.show(camera.look({kWall - jump, noise, 0.0}));
    const EscapeFigures e = escape(rig, hand, 3000, inFrontOf(kWall - jump));
    const double way = std::max(0.0, resting - (kWall - jump - kStand)) + 3.0 * noise;
    // An answer is valid for 10 mm around the pose of its query, so the tool waits once per 10 mm.
    const double waits = late > 0 ? (std::ceil(way / 0.00999) + 2.0) * (late + 1.0) : 0.0;
    f.ratio = std::max(f.ratio, e.ticks / (std::ceil(way / kDepthPerTick) + kExtraTicks + waits));
    f.ticks = std::max(f.ticks, static_cast<double>(e.ticks));
    f.growth = std::max(f.growth, rig.audit().maxPenetration());
    f.front = std::min(f.front, kWall - jump - rig.pose().position.z);
    f.forceStep = std::max(f.forceStep, rig.figures.forceStep);
    f.forceRise = std::max(f.forceRise, rig.figures.forceRise.most);
    f.torqueRise = std::max(f.torqueRise, rig.figures.torqueRise.rms());
    f.stuck += e.out ? 0 : 1;
    f.flagged += rig.audit().behindTicks() > 0 ? 1 : 0;
    ++f.runs;
}

void requireJump(Outcome& out, const JumpFigures& f) {
    require(out, f.stuck == 0, num(f.stuck) + " runs never out");
    require(out, f.growth <= 1e-5, "a depth grew by " + num(f.growth) + " m");
    require(out, f.front > 0.5 * kStand, "a tool came out " + num(f.front) + " m in front: the far side");
}

std::string wordsOf(const JumpFigures& f) {
    return num(f.runs) + " runs, " + num(f.flagged) + " of them flagged behind; at most " + num(f.ticks) +
           " ticks; ends at least " + num(f.front * 1e3) +
           " mm in front of the new surface; force step at most " + num(f.forceStep) + " N.";
}

JumpFigures jumps(RunLength runLength, double jump, uint32_t late) {
    JumpFigures f;
    const Tool ball = ballTool(kTool);
    const int trials = some(runLength, 40, 4);
    for (int i = 0; i < trials; ++i) {
        jumpOnce(ball, jump, i % 2 == 0 ? 0.0 : 0.0005, i % 4 < 2 ? 0.0 : 0.02, late,
                 static_cast<uint64_t>(i + 1), f);
    }
    return f;
}

Outcome jumpCase(RunLength runLength, double jump) {
    const JumpFigures f = jumps(runLength, jump, 0);
    Outcome out =
        outcomeOf(f.ratio, 1.0, "1",
                  "Ticks until the tool is out, divided by distance / 1 mm + 3: a wall 500 mm away jumps " +
                      num(jump * 1e3) +
                      " mm over a ball of 10 mm with regions of 40 mm, pressed or not, noise 0 or 0.5 mm. " +
                      wordsOf(f));
    requireJump(out, f);
    return out;
}

Outcome lateJumpCase(RunLength runLength, uint32_t late) {
    JumpFigures all;
    for (const double jump : {0.01, 0.055}) {
        const JumpFigures f = jumps(runLength, jump, late);
        all.ratio = std::max(all.ratio, f.ratio);
        all.ticks = std::max(all.ticks, f.ticks);
        all.growth = std::max(all.growth, f.growth);
        all.front = std::min(all.front, f.front);
        all.forceStep = std::max(all.forceStep, f.forceStep);
        all.stuck += f.stuck;
        all.runs += f.runs;
        all.flagged += f.flagged;
    }
    Outcome out = outcomeOf(all.ratio, 1.0, "1",
                            "Ticks until out over what 1 mm per tick and a wait for every 10 mm of certified "
                            "reach allow: jumps of 10 "
                            "and 55 mm, answers late by " +
                                num(uint64_t{late}) + " ms. " + wordsOf(all));
    requireJump(out, all);
    return out;
}

// All jumps, with a tool whose leaves act as levers. Checks the force or torque that the hand feels.
Outcome stepCase(RunLength runLength, bool torque) {
    JumpFigures f;
    const Tool cross = toolOf(crossLeaves(0.008));
    uint64_t seed = 1;
    for (const double jump : {0.002, 0.01, 0.03, 0.06}) {
        for (int i = 0; i < some(runLength, 12, 2); ++i) {
            jumpOnce(cross, jump, 0.0005, i % 2 == 0 ? 0.0 : 0.03, 0, ++seed, f);
        }
    }
    Outcome out = outcomeOf(
        torque ? f.torqueRise : f.forceRise, torque ? kMaxTorqueRise : kMaxForceRise, torque ? "N m" : "N",
        std::string(torque ? "RMS rise per tick of the torque" : "Largest rise per tick of the force") +
            ", which must stay below the slew limit, while the wall jumps 2 to 60 mm over a tool "
            "of "
            "nine leaves. Limit: measured, with a margin. " +
            num(f.runs) + " runs.");
    require(out, f.growth <= 1e-5, "a depth grew by " + num(f.growth) + " m");
    require(out, f.forceStep > 0.0, "no force was felt");
    require(out, f.stuck == 0, num(f.stuck) + " runs never out");
    return out;
}

// Worst values over the runs of a case in which a wall approaches the tool.
struct SweepFigures {
    double ratio = 0.0; // ticks until the tool is out over those allowed
    double front = 1.0; // [m] of the tool in front of the wall at the end
    double growth = 0.0, forceStep = 0.0;
    uint64_t stuck = 0;

    void sweep(int run, double speed);
};

// The wall approaches the tool frame by frame.
void SweepFigures::sweep(int run, double speed) {
    Rng rng(static_cast<uint64_t>(40 + run));
    WallCamera camera(run % 2 == 1, static_cast<uint64_t>(run + 1));
    const double noise = run % 4 < 2 ? 0.0 : 0.0005;
    const Pose hand{dvec3(rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02), 0.6 - kStand - 0.01), kUpright};
    LockstepRig rig(ballTool(kTool), hand);
    const auto frames = static_cast<int>(std::ceil(kSweep / (speed * WallCamera::kFrame)));
    int tick = 0;
    double z = 0.6;
    for (int frame = 0; frame <= frames; ++frame) {
        z = std::max(0.6 - kSweep, 0.6 - speed * WallCamera::kFrame * frame);
        rig.show(camera.look({z, noise, 0.0}));
        for (; frame < frames && tick < (frame + 1) * 1000 / 30; ++tick) {
            rig.step(hand);
        }
    }
    const EscapeFigures e = escape(rig, hand, 3000, inFrontOf(z));
    const double swept = frames * WallCamera::kFrame * 1000.0;
    ratio = std::max(ratio, (tick + e.ticks) /
                                (std::max(std::ceil(kSweep / kDepthPerTick), swept) + 34.0 + kExtraTicks));
    front = std::min(front, z - rig.pose().position.z);
    growth = std::max(growth, rig.audit().maxPenetration());
    forceStep = std::max(forceStep, rig.figures.forceStep);
    stuck += e.out ? 0 : 1;
}

Outcome sweepCase(RunLength runLength, double speed) {
    SweepFigures f;
    const int trials = some(runLength, 20, 2);
    for (int i = 0; i < trials; ++i) {
        f.sweep(i, speed);
    }
    Outcome out = outcomeOf(
        f.ratio, 1.0, "1",
        "Ticks from the start of the sweep until out over the longer of the sweep and 250 mm at 1 "
        "mm per tick, and a "
        "frame: wall at " +
            num(speed) + " m/s, 30 Hz, with and without held points and noise, " + num(uint64_t(trials)) +
            " runs. At over 1 m/s the surface outruns the 1 mm per tick and the tool is out "
            "after it has stopped, still on the camera's side (" +
            num(f.front * 1e3) + " mm in front).");
    require(out, f.stuck == 0, num(f.stuck) + " runs never out");
    require(out, f.growth <= 1e-5, "a depth grew by " + num(f.growth) + " m");
    require(out, f.front > 0.5 * kStand, "a tool came out on the far side");
    require(out, f.forceStep <= 2.0 + 1e-9, "force step of " + num(f.forceStep) + " N");
    return out;
}

} // namespace

std::vector<Case> newDataCases() {
    std::vector<Case> cases;
    const auto put = [&](const std::string& name, std::function<Outcome(RunLength)> run) {
        cases.push_back({"new-data-" + name, Group::NewData, std::move(run)});
    };
    for (const int jump : {1, 3, 10, 30, 50, 55, 80, 100}) {
        put("jump-" + std::to_string(jump) + "mm", [jump](RunLength e) { return jumpCase(e, 1e-3 * jump); });
    }
    for (const uint32_t late : {5u, 20u, 100u}) {
        put("jump-late-" + std::to_string(late) + "ms",
            [late](RunLength e) { return lateJumpCase(e, late); });
    }
    put("force-step", [](RunLength e) { return stepCase(e, false); });
    put("torque-step", [](RunLength e) { return stepCase(e, true); });
    put("sweep-05", [](RunLength e) { return sweepCase(e, 0.5); });
    put("sweep-15", [](RunLength e) { return sweepCase(e, 1.5); });
    put("sweep-3", [](RunLength e) { return sweepCase(e, 3.0); });
    addStreamCases(cases);
    return cases;
}

} // namespace fathom::stability
