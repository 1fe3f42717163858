// SPDX-License-Identifier: Apache-2.0
// Group feel: what a hand feels at a surface that a camera sees with noise. Defaults of a scene, device
// `ideal`.
#include "apps/stability/case_text.h"
#include "apps/stability/feel_guidance.h"
#include "apps/stability/feel_loops.h"
#include "apps/stability/feel_noise_model.h"
#include "apps/stability/feel_rig.h"

#include <algorithm>
#include <numbers>

namespace fathom::stability {

namespace {

constexpr double kSlew = 1.98;    // [N] per tick: within 1 % of the default slew limit
constexpr double kReversal = 0.3; // [N]
constexpr double kLanding = 0.5;  // [s] from 20 mm above the surface to the depth of the case
constexpr double kSettled = 0.8;  // [s] from when the figures count

void requireFelt(Outcome& out, const FeelRig& felt) {
    const double deepest = felt.rig().audit().maxPenetration();
    require(out, deepest <= 1e-9, "a leaf was " + num(deepest) + " m inside a region");
    require(out, felt.rig().figures.contact > 0, "the tool never touched");
    require(out, felt.rig().figures.notFinite == 0, "a wrench that is not finite");
}

std::vector<HandWaypoint> landOn(const Pose& above, const Pose& pressed) {
    return {{0.0, above, 0}, {kLanding, pressed, 0}};
}

FeelRig stillOnRing(double angle, double depth, double seconds) {
    FeelRig felt({});
    felt.follow(landOn(felt.onRing(angle, -0.02), felt.onRing(angle, depth)));
    felt.run(kSettled);
    felt.forget();
    felt.run(seconds);
    return felt;
}

enum class StillFigure { Rms, Band, Torque };

Outcome stillCase(RunLength runLength, double depth, StillFigure what, double limit) {
    const double seconds = some(runLength, 4, 1);
    double worst = 0.0, stiffness = 1.0;
    const int places = some(runLength, 3, 1);
    Outcome out = outcomeOf(0.0, limit, what == StillFigure::Torque ? "N m" : "N", "");
    for (int place = 0; place < places; ++place) {
        const FeelRig felt = stillOnRing(2.0 + place, depth, seconds);
        stiffness = 1000.0 / felt.options().springs.stiffness;
        const FeltTrace& t = felt.trace();
        worst = std::max(worst, what == StillFigure::Rms    ? stiffness * t.forceRms()
                                : what == StillFigure::Band ? stiffness * t.forceBand(10.0, 35.0)
                                                            : t.torqueRms());
        requireFelt(out, felt);
    }
    const std::string failed = out.note;
    const char* const names[] = {"RMS of the force", "Force in 10 to 35 Hz", "RMS of the torque"};
    out = outcomeOf(worst, limit, out.unit,
                    std::string(names[static_cast<size_t>(what)]) + " at a still hand " + num(1e3 * depth) +
                        " mm below the surface of a ring, noise drawn anew in every frame" +
                        (what == StillFigure::Torque ? "" : ", at 1000 N/m") + ". " + num(uint64_t(places)) +
                        " places.");
    require(out, failed.empty(), failed);
    return out;
}

// Small debts of noisy frames must not brake a hand that moves in.
Outcome landingCase(RunLength runLength) {
    double worst = 0.0;
    Outcome out = outcomeOf(0.0, 0.2, "N", "");
    const int places = some(runLength, 4, 1);
    for (int place = 0; place < places; ++place) {
        FeelRig felt({});
        const double angle = 1.5 * place + 2.0;
        felt.follow(landOn(felt.onRing(angle, -0.02), felt.onRing(angle, 0.02)));
        felt.run(kSettled);
        worst = std::max(worst, felt.trace().forceStep());
        requireFelt(out, felt);
    }
    const std::string failed = out.note;
    out =
        outcomeOf(worst, 0.2, "N",
                  "Largest change of the force from tick to tick while a hand moves 20 mm into a noisy ring "
                  "at 80 mm/s. " +
                      num(uint64_t(places)) + " places.");
    require(out, failed.empty(), failed);
    return out;
}

FeelRig alongRim(RunLength runLength) {
    FeelRig felt({});
    constexpr double kDepth = 0.012, kSpeed = 0.11; // [m], [m/s]
    const double turn = runLength == RunLength::Full ? 2.0 * std::numbers::pi : 1.5;
    const int nodes = runLength == RunLength::Full ? 72 : 18;
    std::vector<HandWaypoint> path = landOn(felt.onRing(0.0, -0.02), felt.onRing(0.0, kDepth));
    for (int i = 1; i <= nodes; ++i) {
        const double angle = turn * i / nodes;
        path.push_back({kSettled + 0.1 * angle / kSpeed, felt.onRing(angle, kDepth), 0});
    }
    felt.follow(path);
    felt.run(kSettled);
    felt.forget();
    felt.run(0.1 * turn / kSpeed);
    return felt;
}

Outcome rimCase(RunLength runLength) {
    const FeelRig felt = alongRim(runLength);
    const FeltTrace& t = felt.trace();
    const uint64_t slewed = t.stepsOver(kSlew), reversed = t.reversals(kReversal);
    Outcome out =
        outcomeOf(static_cast<double>(slewed + reversed), 0.0, "ticks",
                  "A hand slides 12 mm deep along a noisy ring at 0.11 m/s: ticks at the slew limit "
                  "and reversals over 0.3 N. Largest step " +
                      num(t.forceStep()) + " N, mean force " + num(glm::length(t.meanForce())) + " N.");
    requireFelt(out, felt);
    return out;
}

Outcome rimClicksCase(RunLength runLength) {
    const FeelRig felt = alongRim(runLength);
    Outcome out = outcomeOf(felt.trace().forceBand(100.0, 500.0), 0.06, "N",
                            "The same run: force above 100 Hz, which is felt as clicks.");
    requireFelt(out, felt);
    return out;
}

// Presses 20 mm deep and leaves within 0.3 s.
Outcome leaveCase(RunLength runLength) {
    constexpr double kMax = 0.05; // [N]
    double worst = 0.0;
    Outcome out = outcomeOf(0.0, kMax, "N", "");
    const int places = some(runLength, 4, 1);
    for (int place = 0; place < places; ++place) {
        FeelRig felt({});
        const double angle = 1.5 * place + 0.4;
        std::vector<HandWaypoint> path = landOn(felt.onRing(angle, -0.02), felt.onRing(angle, 0.02));
        path.push_back({1.0, felt.onRing(angle, 0.02), 0});
        path.push_back({1.3, felt.onRing(angle, -0.04), 0});
        felt.follow(path);
        felt.run(1.0);
        felt.forget();
        felt.run(0.5);
        worst = std::max(worst, felt.trace().steepestRise(0.001) * 0.001);
        requireFelt(out, felt);
        require(out, glm::length(felt.last().wrench.force) == 0.0, "force after the hand has left");
    }
    const std::string failed = out.note;
    out = outcomeOf(worst, kMax, "N",
                    "Largest rise of the force from tick to tick while a hand leaves from 20 mm below the "
                    "surface at 0.2 m/s; no force afterwards. " +
                        num(uint64_t(places)) + " places.");
    require(out, failed.empty(), failed);
    return out;
}

// Rolls and tilts the gripper while it presses 8 mm deep.
Outcome pivotCase(RunLength runLength) {
    FeelRig felt({});
    const double angle = 2.0, depth = 0.008;
    const Pose pressed = felt.onRing(angle, depth);
    std::vector<HandWaypoint> path = landOn(felt.onRing(angle, -0.02), pressed);
    const int swings = some(runLength, 2, 1);
    double t = kSettled;
    for (int k = 0; k < swings; ++k) {
        for (const dvec3& turn : {dvec3(0.0, 0.0, 0.7), dvec3(0.0), dvec3(0.0, 0.0, -0.7), dvec3(0.0),
                                  dvec3(0.0, 0.4, 0.0), dvec3(0.0), dvec3(0.0, -0.4, 0.0), dvec3(0.0)}) {
            t += 0.5;
            path.push_back({t, {pressed.position, rotationExp(turn)}, 0});
        }
    }
    felt.follow(path);
    felt.run(kSettled);
    felt.forget();
    felt.run(t - kSettled);
    const FeltTrace& felts = felt.trace();
    Outcome out = outcomeOf(
        felts.forceBand(100.0, 500.0), 0.03, "N",
        "Force above 100 Hz while a gripper that presses 8 mm deep rolls by 0.7 and tilts by "
        "0.4 rad. Force step at most " +
            num(felts.forceStep()) + " N, torque step at most " + num(felts.torqueStep()) + " N m.");
    requireFelt(out, felt);
    require(out, felts.reversals(kReversal) == 0, "the force reverses");
    return out;
}

// Slides over a clean wall at constant depth, along no axis of the image.
Outcome slideCase(RunLength runLength, double errorBudget) {
    FeelSpec spec;
    spec.scene = "wall";
    spec.noise = false;
    spec.errorBudget = errorBudget;
    spec.focal = 600.0; // 1 mm per pixel
    spec.haptics.stiffness = 1000.0;
    spec.haptics.friction = 0.0; // only the shape of the surface
    spec.ball = true;
    FeelRig felt(spec);
    const Pose from = felt.at(-0.04, 0.013, 0.02), to = felt.at(0.04, 0.018, 0.02);
    const double way = some(runLength, 4, 1);
    felt.follow({{0.0, felt.at(-0.04, 0.013, -0.02), 0},
                 {kLanding, from, 0},
                 {kSettled, from, 0},
                 {kSettled + 4.0, to, 0}});
    felt.run(kSettled + 0.2);
    felt.forget();
    felt.run(way - 0.3);
    const double tooth = felt.trace().sawtooth(glm::normalize(to.position - from.position), 0.3);
    Outcome out = outcomeOf(tooth, 0.02, "N",
                            "Lateral sawtooth (half of peak to peak) of a ball that slides 20 mm deep over a "
                            "clean wall, error budget " +
                                num(1e3 * errorBudget) + " mm; mean force " +
                                num(glm::length(felt.trace().meanForce())) + " N.");
    requireFelt(out, felt);
    return out;
}

// A set that comes nearer by v every frame must be felt as a ramp.
Outcome approachCase(RunLength runLength, double speed) {
    const double reach = 0.012; // [m]
    const double rise = approachRise(speed, reach, some(runLength, 3, 1));
    return outcomeOf(rise / speed, 2.0, "K v",
                     "Steepest rise of the force at a still hand while a clean wall comes " +
                         num(1e3 * reach) + " mm at " + num(speed) + " m/s, 30 frames per second.");
}

} // namespace

std::vector<Case> feelCases() {
    std::vector<Case> cases;
    const auto put = [&](const std::string& name, std::function<Outcome(RunLength)> run) {
        cases.push_back({"feel-" + name, Group::Feel, std::move(run)});
    };
    put("still-5mm", [](RunLength e) { return stillCase(e, 0.005, StillFigure::Rms, 0.05); });
    put("still-20mm", [](RunLength e) { return stillCase(e, 0.02, StillFigure::Rms, 0.2); });
    put("still-20mm-10-35-hz", [](RunLength e) { return stillCase(e, 0.02, StillFigure::Band, 0.025); });
    put("still-20mm-torque", [](RunLength e) { return stillCase(e, 0.02, StillFigure::Torque, 0.005); });
    put("landing", landingCase);
    put("rim", rimCase);
    put("rim-clicks", rimClicksCase);
    put("leave", leaveCase);
    put("pivot", pivotCase);
    put("slide", [](RunLength e) { return slideCase(e, 0.0001); });
    put("slide-budget-1mm", [](RunLength e) { return slideCase(e, 0.001); });
    put("approach-003", [](RunLength e) { return approachCase(e, 0.03); });
    put("approach-01", [](RunLength e) { return approachCase(e, 0.1); });
    put("approach-03", [](RunLength e) { return approachCase(e, 0.3); });
    addFeelLoops(cases);
    addFeelGuidance(cases);
    addFeelNoiseModel(cases);
    return cases;
}

} // namespace fathom::stability
