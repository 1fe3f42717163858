// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/new_data_streams.h"

#include "apps/stability/case_text.h"
#include "apps/stability/escape_run.h"
#include "apps/stability/wall_camera.h"
#include "apps/stability/worlds.h"
#include "devices/recorded/recorded_camera.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kStreamBall = 0.01, kStreamWall = 0.5;            // [m]
constexpr double kStreamStand = WallCamera::kRegion + kStreamBall; // [m]
constexpr double kSlewStep = 2.0 * (1.0 + 1e-9);                   // [N] per tick at 2000 N/s and 1 kHz

void requireSound(Outcome& out, const LockstepRig& rig) {
    const double deepest = rig.audit().maxPenetration();
    require(out, deepest <= 1e-5, "a depth grew by " + num(deepest) + " m");
    require(out, rig.figures.forceStep <= kSlewStep, "force step of " + num(rig.figures.forceStep) + " N");
    require(out, rig.figures.notFinite == 0, "a wrench that is not finite");
    require(out, rig.figures.contact > 0, "the tool never touched");
}

std::string wordsOf(const LockstepRig& rig) {
    return num(rig.figures.ticks) + " ticks, force step at most " + num(rig.figures.forceStep) +
           " N, force up to " + num(rig.figures.force) + " N, " + num(rig.figures.escape) +
           " ticks escaping, " + num(rig.figures.trapped) + " trapped, deepest beyond the allowance " +
           num(rig.audit().maxPenetration()) + " m.";
}

// The hand presses 15 mm into the wall while every frame loses some of its pixels. Figure: how far the tool
// sinks.
Outcome flickerCase(RunLength runLength, bool hold) {
    WallCamera camera(hold, 3);
    const Pose hand{dvec3(0.004, -0.003, kStreamWall - kStreamStand + 0.015), kUpright};
    LockstepRig rig(ballTool(kStreamBall), {hand.position - dvec3(0, 0, 0.02), kUpright});
    rig.show(camera.look({kStreamWall, 0.0, 0.0}));
    for (int k = 0; k < 200; ++k) {
        rig.step(hand);
    }
    const double resting = rig.pose().position.z;
    double deepest = resting, hole = 0.0;
    Outcome::Curve curve{hold ? "with hold" : "without hold",
                         "time [s]",
                         "tool below its resting place [mm]",
                         {},
                         {},
                         false,
                         false};
    const int frames = some(runLength, 300, 20);
    for (int frame = 0; frame < frames; ++frame) {
        rig.show(camera.look({kStreamWall, 0.0, 0.24}));
        hole = std::max(hole, camera.largestHole(rig.pose().position.x, rig.pose().position.y));
        for (int k = 0; k < 33; ++k) {
            rig.step(hand);
            deepest = std::max(deepest, rig.pose().position.z);
        }
        curve.x.push_back(frame * WallCamera::kFrame);
        curve.y.push_back(1e3 * (rig.pose().position.z - resting));
    }
    // In a hole of radius h the tool sinks until it touches the rim. Held points leave no hole.
    const double theory = hold ? 0.0 : kStreamStand - std::sqrt(kStreamStand * kStreamStand - hole * hole);
    Outcome out = outcomeOf(
        deepest - resting, theory + 2e-4, "m",
        "How far a tool pressed 15 mm into the wall sinks while 24 % of the pixels flicker, hold " +
            std::string(hold ? "on" : "off") + ", " + num(uint64_t(frames)) + " frames. Limit: " +
            (hold ? std::string("nothing")
                  : "R + r - sqrt((R + r)^2 - h^2) for the largest hole, h = " + num(hole * 1e3) + " mm") +
            ", and twice the error budget. " + wordsOf(rig));
    requireSound(out, rig);
    out.curves.push_back(std::move(curve));
    return out;
}

// Entire frames without depth.
Outcome dropoutCase(RunLength runLength, bool hold) {
    WallCamera camera(hold, 4);
    const Pose hand{dvec3(0.001, 0.002, kStreamWall - kStreamStand + 0.015), kUpright};
    LockstepRig rig(ballTool(kStreamBall), {hand.position - dvec3(0, 0, 0.02), kUpright});
    double worst = 0.0;
    const int rounds = some(runLength, 60, 4);
    uint64_t stuck = 0;
    for (int round = 0; round < rounds; ++round) {
        rig.show(camera.look({kStreamWall, 0.0, 0.0}));
        for (int k = 0; k < 200; ++k) {
            rig.step(hand);
        }
        const double resting = rig.pose().position.z;
        for (int blind = 0; blind < 5; ++blind) {
            rig.show(camera.look({kStreamWall, 0.0, 1.0}));
            for (int k = 0; k < 33; ++k) {
                rig.step(hand);
            }
        }
        const double sunk = rig.pose().position.z - resting;
        rig.show(camera.look({kStreamWall, 0.0, 0.0}));
        const EscapeFigures e = escape(rig, hand, 400);
        stuck += e.out ? 0 : 1;
        worst = std::max(worst, hold ? sunk : e.ticks / (std::ceil(std::max(0.0, sunk) / 1e-3) + 3.0));
    }
    Outcome out =
        hold ? outcomeOf(worst, 1e-6, "m",
                         "How far a pressed tool sinks in five blind frames (0.17 s) with a hold of 0.5 s; "
                         "it must not sink. ")
             : outcomeOf(worst, 1.0, "1",
                         "Without held points the tool follows the hand 15 mm into the wall in five blind "
                         "frames; ticks until it is out, over distance / 1 mm + 3. ");
    out.note += wordsOf(rig);
    requireSound(out, rig);
    require(out, stuck == 0, num(stuck) + " times never out");
    return out;
}

// A stream whose wall never settles.
struct Restless {
    double noise, leap; // [m] sigma of the depths; step of the wall towards the tool in every second frame
    int ticksPerFrame;
    bool rms;     // the figure is the RMS rise, otherwise the largest
    double limit; // [N] measured value plus a margin
};

Outcome restlessCase(RunLength runLength, const Restless& stream, const std::string& what) {
    WallCamera camera(false, 5);
    const Pose hand{dvec3(-0.003, 0.001, kStreamWall - kStreamStand + 0.01), kUpright};
    LockstepRig rig(toolOf(crossLeaves(0.008)), {hand.position - dvec3(0, 0, 0.15), kUpright});
    const int frames = some(runLength, 600, 40);
    for (int frame = -1; frame < frames; ++frame) { // the first is the approach
        rig.show(camera.look({kStreamWall - (frame % 2 == 1 ? stream.leap : 0.0), stream.noise, 0.0}));
        for (int k = 0; k < (frame < 0 ? 200 : stream.ticksPerFrame); ++k) {
            rig.step(hand);
        }
        rig.figures.forceRise = frame < 0 ? Rise{} : rig.figures.forceRise;
    }
    Outcome out = outcomeOf(
        stream.rms ? rig.figures.forceRise.rms() : rig.figures.forceRise.most, stream.limit, "N",
        std::string(stream.rms ? "RMS" : "Largest") +
            " rise per tick of the force, which must stay far below the slew limit of 2 N: " + what +
            " Limit: measured, with a margin. " + wordsOf(rig));
    requireSound(out, rig);
    return out;
}

HostFixtures vice(double overlap) { // two walls of spheres, closer than the ball needs by 2 x overlap
    HostFixtures set;
    const double half = kStreamStand - overlap;
    addWall(set, dvec3(0, 0, -half), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.12, 0.004, 0.04);
    addWall(set, dvec3(0, 0, half), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.12, 0.004, 0.04);
    return set;
}

struct ViceRun {
    int recognised = -1;     // ticks until trapped
    double moved = 0.0;      // [m] while trapped
    double forceAfter = 0.0; // [N] 0.2 s later
    EscapeFigures left;
};

// The vice closes, holds the tool for 0.4 s, then one jaw disappears.
ViceRun closeVice(LockstepRig& rig, double overlap, const Pose& hand) {
    ViceRun run;
    rig.show(vice(-0.003));
    for (int k = 0; k < 100; ++k) {
        rig.step(hand);
    }
    rig.show(vice(overlap));
    const dvec3 held = rig.pose().position;
    for (int k = 1; k <= 400; ++k) {
        const StepRecord record = rig.step(hand);
        if (run.recognised < 0 && record.state == StepState::Trapped) {
            run.recognised = k;
        }
        run.moved = std::max(run.moved, glm::distance(record.tool.position, held));
        run.forceAfter = k > 201 + std::max(0, run.recognised)
                             ? std::max(run.forceAfter, glm::length(record.wrench.force))
                             : 0.0;
    }
    HostFixtures open;
    addWall(open, dvec3(0, 0, -(kStreamStand - overlap)), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.12, 0.004, 0.04);
    rig.show(std::move(open));
    run.left = escape(rig, hand, 200);
    return run;
}

enum class ViceFigure { Recognised, ForceOut, Left };

Outcome viceCase(RunLength runLength, ViceFigure what) {
    double worst = 0.0, moved = 0.0;
    Rng rng(6);
    Outcome out = outcomeOf(0.0, 0.0, "1", "");
    const int trials = some(runLength, 40, 4);
    for (int i = 0; i < trials; ++i) {
        const double overlap = rng.logUniform(0.0005, 0.02);
        const Pose hand{0.0005 * rng.direction() + dvec3(0.012 * (i % 2), 0, 0), kUpright};
        LockstepRig rig(ballTool(kStreamBall), {hand.position, kUpright});
        const ViceRun run = closeVice(rig, overlap, hand);
        const double ticks = run.recognised < 0 ? 1e9 : run.recognised;
        const double left = run.left.ticks / (std::ceil((overlap + 0.001) / 1e-3) + 3.0);
        worst = std::max(worst, what == ViceFigure::Recognised ? ticks
                                : what == ViceFigure::ForceOut ? run.forceAfter
                                                               : left);
        moved = std::max(moved, run.moved);
        require(out, run.left.out, "a tool that never left");
        require(out, rig.figures.forceStep <= kSlewStep,
                "force step of " + num(rig.figures.forceStep) + " N");
        require(out, rig.audit().maxPenetration() <= 1e-5, "a depth grew");
    }
    const std::string vices = " Two walls close on the ball, too near by 0.5 to 20 mm on each side; " +
                              num(uint64_t(trials)) + " runs. The tool moved by at most " + num(moved) +
                              " m while held.";
    const std::string failed = out.note;
    const bool sound = failed.empty();
    switch (what) {
    case ViceFigure::Recognised:
        out = outcomeOf(worst, 3.0, "turns", "Ticks until the state says trapped." + vices);
        break;
    case ViceFigure::ForceOut:
        out = outcomeOf(worst, 1e-9, "N", "Force 0.2 s and more after being trapped: it ramps out." + vices);
        break;
    case ViceFigure::Left:
        out = outcomeOf(worst, 1.0, "1",
                        "Ticks until out after one wall is removed, over depth / 1 mm + 4." + vices);
        break;
    }
    require(out, sound, failed);
    return out;
}

// Plays a recording's frames at 30 Hz while the hand presses the tool into its regions.
Outcome recordingCase(RunLength runLength, const std::string& file, const std::string& folder) {
    const World world = recordedWorld(file, folder).value();
    const Scene scene = loadScene(file);
    RecordedCamera camera(recordingFolder(folder));
    ImageFixtures make(scene, camera.info(), true);
    LockstepRig rig(toolOf(world.leaves), world.start);
    const int frames = some(runLength, 60, 4);
    Rng rng(7);
    for (int frame = 0; frame < frames; ++frame) {
        const std::optional<Frame> next = camera.next();
        if (!next) {
            break;
        }
        rig.show(make.make(**next));
        const Pose hand{world.focus + 0.05 * rng.direction(), rotationExp(0.2 * rng.direction())};
        for (int k = 0; k < (frame == 0 ? 300 : 33); ++k) {
            rig.step(hand);
        }
    }
    Outcome out = outcomeOf(rig.audit().maxPenetration(), 1e-5, "m",
                            "Deepest beyond the allowance while the frames of " + folder +
                                " come at 30 Hz and the hand presses into its regions; regions made on the "
                                "CPU by the float64 twins, hold "
                                "on. " +
                                wordsOf(rig));
    requireSound(out, rig);
    return out;
}

void addRecordings(std::vector<Case>& cases) {
    for (const char* name : {"valve_globe", "valve_ball"}) {
        const std::string file = std::string("apps/scenes/") + name + ".yaml",
                          folder = std::string(name) + "_d435";
        if (std::filesystem::exists(recordingFolder(folder)) && std::filesystem::exists(file)) {
            cases.push_back({"new-data-recording-" + folder, Group::NewData,
                             [=](RunLength runLength) { return recordingCase(runLength, file, folder); }});
        }
    }
}

} // namespace

void addStreamCases(std::vector<Case>& cases) {
    const auto put = [&](const char* name, std::function<Outcome(RunLength)> run) {
        cases.push_back({std::string("new-data-") + name, Group::NewData, std::move(run)});
    };
    put("flicker-24-percent", [](RunLength e) { return flickerCase(e, false); });
    put("flicker-24-percent-hold", [](RunLength e) { return flickerCase(e, true); });
    put("dropout-frames", [](RunLength e) { return dropoutCase(e, false); });
    put("dropout-frames-hold", [](RunLength e) { return dropoutCase(e, true); });
    put("noise-5mm", [](RunLength e) {
        return restlessCase(e, {0.005, 0.0, 33, true, 0.03}, "new noise of 5 mm in every frame.");
    });
    put("every-turn", [](RunLength e) {
        return restlessCase(e, {0.001, 0.0, 1, false, 0.2}, "a new set with noise of 1 mm in every tick.");
    });
    put("two-places", [](RunLength e) {
        return restlessCase(e, {0.0, 0.02, 33, false, 0.11}, "a wall 20 mm nearer in every second frame.");
    });
    put("trapped-recognised", [](RunLength e) { return viceCase(e, ViceFigure::Recognised); });
    put("trapped-force-out", [](RunLength e) { return viceCase(e, ViceFigure::ForceOut); });
    put("trapped-left", [](RunLength e) { return viceCase(e, ViceFigure::Left); });
    addRecordings(cases);
}

} // namespace fathom::stability
