// SPDX-License-Identifier: Apache-2.0
// Group guidance: distant targets and flickering targets. guidance_plane_cases.cpp has the cases on point
// sets.
#include "apps/stability/case_text.h"
#include "apps/stability/guidance_parts.h"
#include "apps/stability/loop_rig.h"
#include "engine/reference/rng.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

double angleBetween(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// With the target out of reach, guidance pulls with F_g and tau_g in the right direction, in both modes.
Outcome farTarget(RunLength runLength) {
    double worst = 0.0;
    Rng rng(1);
    const int targets = runLength == RunLength::Full ? 2000 : 300;
    const GuidanceLimits limits;
    for (int n = 0; n < targets; ++n) {
        GuidancePose target;
        target.present = target.planar = true;
        target.rollFree = n % 2 == 0;
        const double distance = rng.logUniform(0.01, 1e6);
        const dvec3 way = rng.direction();
        target.target = {distance * way, rng.rotation()};
        Guidance guidance;
        guidance.step({}, {}, false, false, 0.001);
        for (int i = 0; i < 600; ++i) {
            guidance.step({&target, 1}, {}, true, false, 0.001);
        }
        Springs springs;
        springs.stiffness = 1000.0;
        springs.rotationalStiffness = 1.0;
        springs.metricRadius = 0.0316;
        springs.guidanceStiffness = 250.0;
        const Guidance::Lead lead = guidance.lead({}, springs);
        const Wrench pull = guidance.pull({}, springs);
        worst = std::max({worst, std::abs(springs.stiffness * glm::length(lead.translation) - limits.force),
                          std::abs(glm::length(pull.force) - limits.force),
                          limits.force * angleBetween(lead.translation, way),
                          springs.rotationalStiffness * glm::length(lead.rotation) - limits.torque,
                          glm::length(pull.torque) - limits.torque});
    }
    return outcomeOf(worst, 1e-9, "N",
                     "Targets 10 mm to 1000 km away, any orientation: error of the pull against F_g = 2 N in "
                     "size and direction, or its excess over 0.1 N m, in both modes; " +
                         num(uint64_t(targets)) + " targets.");
}

struct FlickerFigures {
    double largest = 0.0; // [N] step of the force between two ticks
    int changes = 0;      // of the chosen class
};

// One or two classes, each with one valve.
std::vector<GuidancePose> valvePoses(size_t classes) {
    std::vector<GuidancePose> poses(classes);
    for (size_t i = 0; i < poses.size(); ++i) {
        poses[i].planar = poses[i].present = true;
        poses[i].target.position = {i == 0 ? 0.3 : -0.3, 0.02, 0.0};
        poses[i].target.rotation = rotationExp({0.0, 0.0, i == 0 ? 0.5 : -0.5});
    }
    return poses;
}

// What the next frame shows: a single class at another valve, or only one of two classes.
void flickerOnce(std::vector<GuidancePose>& poses, Rng& rng) {
    if (poses.size() == 1) {
        poses[0].target.position.x = rng.chance(0.5) ? 0.3 : -0.3;
    } else {
        poses[0].present = rng.chance(0.6);
        poses[1].present = !poses[0].present || rng.chance(0.5);
    }
}

void runFlicker(size_t classes, int ticks, Rng& rng, FlickerFigures& figures) {
    LoopSpec spec;
    spec.stiffness = 1000.0;
    const Tool tool(buildSphereTree(spec.leaves));
    HapticCycle cycle(tool, std::span<const Shape>{}, loopOptions(spec, tool), {});
    std::vector<GuidancePose> poses = valvePoses(classes);
    dvec3 before(0.0);
    int chosen = -2;
    for (int i = 0; i < ticks; ++i) {
        if (i % 33 == 0) { // a frame
            flickerOnce(poses, rng);
        }
        StepInput input = stepInput({Pose{}, i > 100 ? kGuidanceButton : 0}, i * 0.001);
        input.guidance = poses;
        const StepRecord record = cycle.step(input);
        figures.largest = std::max(figures.largest, glm::distance(record.wrench.force, before));
        before = record.wrench.force;
        const bool both = chosen >= 0 && record.guidanceClass >= 0;
        figures.changes += classes > 1 && both && record.guidanceClass != chosen ? 1 : 0;
        chosen = record.guidanceClass;
    }
}

// Two valves: one class whose position flips between them, then two classes that disappear in turn.
Outcome flicker(RunLength runLength) {
    FlickerFigures figures;
    Rng rng(2);
    for (const size_t classes : {1u, 2u}) {
        runFlicker(classes, runLength == RunLength::Full ? 60000 : 8000, rng, figures);
    }
    // The lead is 2 mm at 2 N. A slew of 0.1 m/s moves it by at most 0.1 mm per tick, which changes the force
    // by at most 0.1 N per tick.
    Outcome out = outcomeOf(figures.largest, 0.1 + 1e-6, "N",
                            "A target that flips between two valves 0.6 m apart at random frames, and two "
                            "classes that come and go: largest step of the force "
                            "between two ticks. Limit: the slew of 0.1 m/s times K = 1000 N/m and 1 ms.");
    require(out, figures.changes == 0,
            "the valve was changed " + std::to_string(figures.changes) + " times while the button was held");
    return out;
}

} // namespace

std::vector<Case> guidanceCases() {
    std::vector<Case> all{{"guidance-target-out-of-reach", Group::Guidance, farTarget},
                          {"guidance-flickers-between-two-valves", Group::Guidance, flicker}};
    for (Case& one : guidancePlaneCases()) {
        all.push_back(std::move(one));
    }
    return all;
}

} // namespace fathom::stability
