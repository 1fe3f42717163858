// SPDX-License-Identifier: Apache-2.0
// Runs the haptic cycle in lockstep: one contact answer before each tick, a clock, and a hand that the test
// moves.
#pragma once

#include "engine/contact/cull_cpu.h"
#include "engine/cycle/arm_setup.h"
#include "engine/cycle/haptic_cycle.h"
#include "engine/reference/contact_oracle.h"
#include "engine/run/delayed_contacts.h"
#include "engine/run/scene_update.h"
#include "tests/contact/clouds.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace fathom::testing {

inline Pose at(double x, double y, double z) {
    return {{x, y, z}, {1.0, 0.0, 0.0, 0.0}};
}

// One leaf of 10 mm at the tool's origin.
inline Tool ballTool() {
    const Sphere ball{{0.0, 0.0, 0.0}, 0.01};
    return Tool(buildSphereTree({&ball, 1}));
}

// Horizontal wall of spheres of 40 mm radius with tops at z = 0; the tool's centre rests near z = 0.01.
inline HostFixtures wallSet(uint64_t generation = 1) {
    HostFixtures fixtures = emptySet(generation);
    addWall(fixtures, {0.0, 0.0, -0.04}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.04);
    return fixtures;
}

// The scene with springs alone: 1000 N/m for device `ideal`, no friction or damping, each sphere for itself.
// The figures of the tests are those of the springs.
inline Scene springsAlone(Scene scene) {
    scene.haptics.friction = 0.0;
    scene.haptics.damping = 0.0;
    scene.haptics.margin = 1.0;
    scene.haptics.smooth = false;
    return scene;
}

class HapticRig {
public:
    // setup: null = the tool moves freely; else it is the tip of this arm.
    explicit HapticRig(const Scene& wanted, const Pose& start, Tool made = ballTool(),
                       std::unique_ptr<ArmSetup> setup = nullptr)
        : tool(std::move(made))
        , arm(std::move(setup))
        , options(makeHapticOptions(springsAlone(wanted), tool))
        , hand(start) {
        restart();
    }

    void restart() {
        cycle = std::make_unique<HapticCycle>(tool, std::span<const Shape>{}, options, hand,
                                              arm ? &hand : nullptr, arm.get());
    }

    void show(HostFixtures set) {
        fixtures = std::move(set);
        grid.build(fixtures->spheres);
        scene.show(*fixtures);
        scene.captureTime = time;
        sceneAges = true;
    }

    StepRecord step() {
        if (fixtures && query) {
            contacts.push(answer());
        }
        contacts.offerDue(late);
        placed = realArm && cycle->follow(*realArm);
        if (!sceneAges) {
            scene.captureTime = time;
        }
        StepInput input = stepInput(scene, {hand, buttons, present}, time);
        input.guidance = guidance;
        input.forcesOff = forcesOff;
        input.measuredPeriod = measured;
        change(input);
        const StepRecord record = contacts.step(*cycle, input);
        time += measured > 0.0 ? measured : options.period;
        return record;
    }
    StepRecord ticks(int count) {
        StepRecord record;
        for (int i = 0; i < count; ++i) {
            record = step();
        }
        return record;
    }
    std::unique_ptr<ContactSet> answer() {
        auto set = std::make_unique<ContactSet>();
        const QueryPlace at = cycle->queryPlace();
        const double all = reach + at.extraReach;
        if (arm) { // its leaves are already in the base frame
            cull.query(arm->toolAt(at.place.arm), Pose{}, all, *fixtures, grid, *set);
        } else {
            cull.query(tool, at.place.pose, all, *fixtures, grid, *set);
        }
        set->askedAt = at.askedAt;
        set->query = ++queries;
        return set;
    }
    double gap() const { // [m] smallest, by brute force
        return arm ? oracleSmallestGap(arm->toolAt(cycle->place().arm), Pose{}, *fixtures)
                   : oracleSmallestGap(tool, cycle->pose(), *fixtures);
    }

    Tool tool;
    std::unique_ptr<ArmSetup> arm;
    HapticOptions options;
    std::unique_ptr<HapticCycle> cycle;
    CullCpu cull;
    RegionGrid grid;
    std::optional<HostFixtures> fixtures;
    DelayedContacts contacts;
    uint64_t queries = 0;
    SceneUpdate scene;                  // of `fixtures`
    std::vector<GuidancePose> guidance; // instead of that of `fixtures`
    Pose hand;
    double time = 0.0;
    double measured = 0.0; // [s] measured tick period; 0 = the nominal period, as in lockstep
    bool sceneAges = true; // false: every tick has a new capture time
    bool query = true;
    double reach = 0.01; // [m] of contact queries
    size_t late = 0;     // ticks until an answer is offered
    bool present = true; // the device renders and is heard
    uint32_t buttons = 0;
    bool forcesOff = false;
    std::optional<ArmFollow> realArm; // status of a real arm that follows; none: there is none
    bool placed = false;              // the last step started from where that arm was measured
    std::function<void(StepInput&)> change = [](StepInput&) {}; // of each input, before the step
};

inline double forceOf(const StepRecord& record) {
    return glm::length(record.wrench.force);
}

// A scene with one forbidden point class.
inline Scene handScene(const char* device = "ideal") {
    Scene scene;
    scene.fixtures.emplace_back();
    scene.haptics.device = device;
    return scene;
}

// Pressed 5 mm into the wall and at rest: 5 N at 1000 N/m.
inline HapticRig pressedRig(const Scene& scene = handScene()) {
    HapticRig rig(scene, at(0, 0, 0.02));
    rig.show(wallSet());
    rig.sceneAges = false;
    rig.ticks(250);
    rig.hand = at(0, 0, 0.005);
    rig.ticks(100);
    return rig;
}

} // namespace fathom::testing
