// SPDX-License-Identifier: Apache-2.0
// Group stiff, part three: static fixtures generate no energy in the closed loop.
#include "apps/stability/case_text.h"
#include "apps/stability/pressing.h"
#include "apps/stability/stiff_cases.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kTolerance = 1e-6; // [J]

struct EnergyFigures {
    double net = -1e9;  // [J] largest value from the first touch on
    double given = 0.0; // [J] largest energy out at any time, ignoring the device's damping
    double taken = 0.0; // [J] largest energy that the controller removed
    std::string who;
    size_t runs = 0;
};

// Tracks the largest net energy out, less `allowance` [J/m] times the path.
void pressAndWatch(const LoopSpec& spec, double allowance, EnergyFigures& all) {
    LoopRig rig(spec);
    bool touched = false;
    while (rig.time() < spec.path.back().t) {
        touched = rig.tick().contactCount > 0 || touched;
        all.given = std::max(all.given, rig.energyOut());
        const double net = rig.netEnergyOut() - allowance * rig.path();
        if (touched && net > all.net) {
            all.net = net;
            all.who = nameOf(spec);
        }
    }
    all.taken = std::max(all.taken, rig.cycle().passivity().dissipated());
}

LoopGrid gridFor(RunLength runLength, size_t every) {
    LoopGrid grid;
    grid.hands = {0, 1, 2, 3, 4};
    grid.every = runLength == RunLength::Full ? 1 : every;
    return grid;
}

// What shapes the feel at a surface: none of it, or all of it.
enum class Feel { Bare, Shaped };

// Pushes in, slides and pulls out again.
LoopSpec inAndOut(Ground ground, Feel feel = Feel::Bare) {
    LoopSpec spec = pressedSpec(ground, 1.2);
    spec.friction = feel == Feel::Shaped ? 0.2 : 0.0;
    spec.smooth = feel == Feel::Shaped;
    const HandWaypoint start = spec.path.front();
    spec.path.push_back(wayAt(1.5, start.deviceThandle.position));
    spec.path.push_back(wayAt(2.0, start.deviceThandle.position));
    return spec;
}

Outcome staticGrounds(RunLength runLength, Feel feel) {
    EnergyFigures all;
    for (const Ground ground : kGrounds) {
        LoopGrid grid = gridFor(runLength, 23);
        if (ground == Ground::Spheres) {
            grid.masses = {0.2};
        }
        all.runs += forEachLoop(grid, inAndOut(ground, feel), [&](LoopSpec spec) {
            // A spring throws the free device at the wall at 0.1 m/s and releases it inside.
            spec.hand.stiffness = std::max(spec.hand.stiffness, 10.0);
            // Damping takes a fifth of the device's own, and the spring the rest.
            spec.virtualDamping = feel == Feel::Shaped ? 0.2 * spec.damping : 0.0;
            pressAndWatch(spec, 0.0, all);
        });
    }
    return outcomeOf(
        all.net, kTolerance, "J",
        std::string(feel == Feel::Shaped ? "With friction 0.2, smooth planes and damping: " : "") +
            "Wall, corner, slot and a wall of spheres, pressed, slid along and left: energy from "
            "the fixture into the hand minus the energy that the device's own damping took, largest "
            "at any time after the first touch of " +
            num(uint64_t{all.runs}) + " loops (" + all.who + "); without that damping up to " +
            num(all.given * 1e3) + " mJ (the sampled spring's). Controller on; it took " +
            num(all.taken * 1e6) + " uJ.");
}

Outcome withEncoders(RunLength runLength) {
    EnergyFigures all;
    for (const double step : {1e-6, 1e-5, 1e-4}) {
        LoopSpec base = inAndOut(Ground::Wall);
        base.encoderStep = step;
        all.runs += forEachLoop(gridFor(runLength, 23), base, [&](LoopSpec spec) {
            spec.hand.stiffness = std::max(spec.hand.stiffness, 10.0);
            const double k = passiveStiffness(spec.damping, 0.0, spec.period(), spec.delay);
            pressAndWatch(spec, std::sqrt(3.0) * k * step / 2.0, all);
        });
    }
    return outcomeOf(all.net, kTolerance, "J",
                     "The same wall with encoders of 1 um to 0.1 mm: net energy beyond sqrt(3) K step / 2 "
                     "per metre of path, worst of " +
                         num(uint64_t{all.runs}) + " loops (" + all.who +
                         "). The allowed part is physics: a position is known to half a step on each axis, "
                         "the force is wrong by up to K times that, and no controller can detect it.");
}

// The same loop with the controller on and off is bit-identical unless the controller acted.
Outcome controllerIdle(RunLength runLength) {
    double largest = 0.0;
    size_t runs = 0;
    for (const Ground ground : kGrounds) {
        LoopGrid grid = gridFor(runLength, 31);
        if (ground == Ground::Spheres) {
            grid.masses = {0.2};
        }
        runs += forEachLoop(grid, inAndOut(ground), [&](LoopSpec spec) {
            LoopRig on(spec);
            spec.controller = false;
            LoopRig off(spec);
            while (on.time() < spec.path.back().t) {
                const Wrench a = on.tick().wrench, b = off.tick().wrench;
                largest =
                    std::max({largest, glm::distance(a.force, b.force), glm::distance(a.torque, b.torque)});
            }
        });
    }
    return outcomeOf(largest, 1e-9, "N",
                     "The passivity controller changes no force if no energy is generated: largest "
                     "difference of the wrench with and without it over " +
                         num(uint64_t{runs}) +
                         " loops with static fixtures, delays of 0, 1 and 3 ticks included.");
}

} // namespace

std::vector<Case> energyCases() {
    return {{"static-fixtures-give-no-energy", Group::Stiff,
             [](RunLength e) { return staticGrounds(e, Feel::Bare); }},
            {"static-fixtures-give-no-energy-shaped", Group::Stiff,
             [](RunLength e) { return staticGrounds(e, Feel::Shaped); }},
            {"static-fixtures-by-encoders", Group::Stiff, withEncoders},
            {"controller-leaves-static-fixtures-alone", Group::Stiff, controllerIdle}};
}

} // namespace fathom::stability
