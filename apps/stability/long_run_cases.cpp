// SPDX-License-Identifier: Apache-2.0
// Group long-run: one million ticks in lockstep with frames, guidance, dead-man button and a roaming hand.
// Nothing drifts or grows, and a repeated run gives the same digest.
#include "apps/output/digest.h"
#include "apps/stability/case_text.h"
#include "apps/stability/loop_rig.h"
#include "apps/stability/worlds.h"
#include "engine/reference/rng.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <unistd.h>

namespace fathom::stability {

namespace {

constexpr double kLegSeconds = 0.35; // from one waypoint of the hand to the next
constexpr int kTicksPerFrame = 33;

uint64_t ticksFor(RunLength runLength) {
    return runLength == RunLength::Full ? 1000000 : 50000;
}

// A hand that moves over and into a wall, flips over, and presses the guidance and dead-man buttons. It does
// not use the clutch, which would let it drift away. It ends at rest far from everything.
LoopSpec roamingSpec(uint64_t ticks) {
    LoopSpec spec;
    spec.hand = kHands[3];
    spec.leaves = crossLeaves(0.008);
    spec.encoderStep = 1e-6;
    spec.encoderAngle = 1e-5;
    spec.fixtures = sphereWall(0.0, 1);
    GuidancePose target;
    target.present = target.planar = true;
    target.target = {{0.01, 0.02, 0.05}, rotationExp({0.4, 0.2, 0.0})};
    spec.guidance = {target};
    Rng rng(77);
    const double seconds = static_cast<double>(ticks) * spec.period();
    double t = 0.0;
    spec.path = {wayAt(0.0, {0.0, 0.0, 0.15})};
    for (; t < seconds - 4.0 * kLegSeconds; t += kLegSeconds) {
        HandWaypoint way = wayAt(
            t + kLegSeconds, {rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), rng.uniform(-0.01, 0.09)});
        way.deviceThandle.rotation = rng.rotation();
        way.buttons = rng.chance(0.3) ? kGuidanceButton : rng.chance(0.05) ? kDeadManOpen : 0u;
        spec.path.push_back(way);
    }
    spec.path.push_back(wayAt(t + kLegSeconds, {0.0, 0.0, 0.15}));
    return spec;
}

double residentMiB() {
    std::ifstream file("/proc/self/statm");
    double pages = 0.0, resident = 0.0;
    file >> pages >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

struct LongRun {
    std::string digest;
    double norm = 0.0;   // largest deviation of a quaternion's length from 1
    double growth = 0.0; // [MiB] memory growth from a tenth of the run to its end
    double clock = 0.0;  // [s] difference of the cycle's clock from ticks x period at the end
    uint64_t contacts = 0, escapes = 0, guided = 0, notFinite = 0;
    double rest = 0.0; // [m] distance from tool to hand at the end
    Outcome::Curve memory{"resident memory", "tick", "MiB", {}, {}, false, false};
};

void judge(const StepRecord& record, LongRun& run, Digest& digest) {
    run.norm = std::max({run.norm, std::abs(glm::length(record.tool.rotation) - 1.0),
                         std::abs(glm::length(record.device.rotation) - 1.0)});
    run.contacts += record.contactCount > 0;
    run.escapes += record.state == StepState::Escape;
    run.guided += record.guidance > 0.0;
    digest.add(record);
}

LongRun roam(uint64_t ticks) {
    LongRun run;
    Digest digest;
    LoopRig rig(roamingSpec(ticks));
    Rng rng(5);
    double early = 0.0;
    uint64_t generation = 1;
    for (uint64_t i = 0; i < ticks; ++i) {
        if (i % kTicksPerFrame == kTicksPerFrame - 1) { // the surface moves by up to 1.5 mm
            rig.show(sphereWall(rng.uniform(0.0, 0.0015), ++generation));
        }
        judge(rig.tick(), run, digest);
        if (i % (ticks / 20) == ticks / 20 - 1) {
            run.memory.x.push_back(static_cast<double>(i + 1));
            run.memory.y.push_back(residentMiB());
        }
        early = i == ticks / 10 ? residentMiB() : early;
    }
    run.growth = residentMiB() - early;
    run.clock = std::abs(rig.time() - static_cast<double>(ticks) * rig.options().period);
    run.notFinite = rig.cycle().notFinite();
    run.rest = glm::distance(rig.last().tool.position, rig.last().device.position);
    run.digest = digest.hex();
    return run;
}

std::string storyOf(const LongRun& run, uint64_t ticks) {
    return num(ticks) +
           " ticks of a closed loop in lockstep: frames at 30 Hz, a hand that moves about, turns over and "
           "presses its buttons (" +
           num(run.contacts) + " ticks in contact, " + num(run.escapes) + " escaping, " + num(run.guided) +
           " guided). ";
}

void requireContact(Outcome& out, const LongRun& run, uint64_t ticks) {
    require(out, run.contacts > ticks / 50 && run.guided > ticks / 50 && run.escapes > 10,
            "contact, guidance and escapes should occur");
    require(out, run.notFinite == 0, "some tick was not finite");
}

Outcome norms(RunLength runLength) {
    const LongRun run = roam(ticksFor(runLength));
    Outcome out = outcomeOf(run.norm, 1e-14, "1",
                            storyOf(run, ticksFor(runLength)) +
                                "Largest distance of a quaternion's length from 1 at any tick.");
    requireContact(out, run, ticksFor(runLength));
    return out;
}

Outcome memory(RunLength runLength) {
    const LongRun run = roam(ticksFor(runLength));
    Outcome out = outcomeOf(run.growth, 1.0, "MiB",
                            storyOf(run, ticksFor(runLength)) +
                                "Growth of the process from a tenth of the run to its end.");
    requireContact(out, run, ticksFor(runLength));
    out.curves.push_back(run.memory);
    return out;
}

Outcome digests(RunLength runLength) {
    const LongRun first = roam(ticksFor(runLength)), second = roam(ticksFor(runLength)),
                  other = roam(ticksFor(runLength) / 2);
    Outcome out = outcomeOf(first.digest == second.digest ? 0.0 : 1.0, 0.0, "1",
                            storyOf(first, ticksFor(runLength)) +
                                "Digests that differ between two equal runs: " + first.digest + ".");
    requireContact(out, first, ticksFor(runLength));
    require(out, other.digest != first.digest, "half of the run should have another digest");
    return out;
}

Outcome rest(RunLength runLength) {
    const LongRun run = roam(ticksFor(runLength));
    Outcome out = outcomeOf(
        run.rest, 1e-9, "m",
        storyOf(run, ticksFor(runLength)) +
            "Back in free space at the end, the tool is where the hand is; the loop's clock was off by " +
            num(run.clock) + " s.");
    requireContact(out, run, ticksFor(runLength));
    return out;
}

} // namespace

std::vector<Case> longRunCases() {
    return {{"long-run-quaternions-keep-their-length", Group::LongRun, norms},
            {"long-run-memory-does-not-grow", Group::LongRun, memory},
            {"long-run-same-digest-twice", Group::LongRun, digests},
            {"long-run-comes-back", Group::LongRun, rest}};
}

} // namespace fathom::stability
