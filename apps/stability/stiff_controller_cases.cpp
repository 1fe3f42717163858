// SPDX-License-Identifier: Apache-2.0
// Group stiff, part five: passivity controller and stiffness monitor when something does generate energy,
// namely moving fixtures, springs beyond the bound, and slow ticks.
#include "apps/stability/case_text.h"
#include "apps/stability/pressing.h"
#include "apps/stability/stiff_cases.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kDepth = 0.003, kJump = 0.002; // [m] energy K p delta + K delta^2 / 2 = 8 mJ at 1000 N/m

// A hand at rest, 3 mm deep in a wall of spheres that then moves.
struct Held {
    LoopSpec spec;
    std::unique_ptr<LoopRig> rig;
    double height = 0.0; // [m] z of the hand at rest
    uint64_t generation = 1;

    Held(const HandModel& hand, bool controller) {
        spec.hand = hand;
        spec.controller = controller;
        spec.fixtures = sphereWall(0.0, generation);
        const double reach = kDepth * (1000.0 + hand.stiffness) / hand.stiffness;
        const dvec3 above(0.0, 0.0, 0.015), pressed(0.0, 0.0, 0.01 - reach);
        spec.path = {wayAt(0.0, above), wayAt(0.3, above), wayAt(1.0, pressed)};
        rig = std::make_unique<LoopRig>(spec);
        rig->run(1.0 + 25.0 * spec.wholeMass() / hand.damping);
        height = rig->hand().handle().position.z;
    }
    void moveWall(double to) { rig->show(sphereWall(to, ++generation)); }
    double rise() const { return rig->hand().handle().position.z - height; }
    double stored() const { // [J]
        const dvec3 f = rig->last().wrench.force;
        return 0.5 * glm::dot(f, f) / rig->options().springs.stiffness;
    }
    // [m] final rise of the hand after a jump of the wall; the wall's and the hand's springs share it.
    double restingRise(double jump) const { return jump * 1000.0 / (1000.0 + spec.hand.stiffness); }
};

constexpr int kRiseTicks = 2500; // twice the longest time constant of the reaction

Outcome injectionCounted(RunLength) {
    double most = 0.0, least = 1.0;
    for (size_t h = 1; h < kHands.size(); ++h) {
        for (const double jump : {0.0005, 0.001, 0.002, 0.003}) {
            Held held(kHands[h], true);
            const double before = held.rig->cycle().passivity().generated(), depth = held.stored();
            const double p = std::sqrt(2.0 * depth / 1000.0);
            held.moveWall(jump);
            for (int i = 0; i < kRiseTicks; ++i) {
                held.rig->tick();
            }
            const double counted = held.rig->cycle().passivity().generated() - before;
            const double expected = 1000.0 * (p * jump + 0.5 * jump * jump);
            most = std::max(most, counted / expected);
            least = std::min(least, counted / expected);
        }
    }
    Outcome out =
        outcomeOf(most, 1.02, "1",
                  "A wall jumps by 0.5 to 3 mm under a hand 3 mm deep, and the reaction rises within 2.5 "
                  "s: energy that the observer counts meanwhile against K p delta + K delta^2/2 (8 mJ at 2 "
                  "mm), 16 loops; least " +
                      num(least) + ". It is less where the hand yields before the force is up.");
    require(out, least > 0.6, "only " + num(least) + " of it counted");
    return out;
}

constexpr double kBurst = 0.008; // [m] more than what is felt slowly as noise

struct Burst {
    double excess = 0.0; // [J] largest energy that the hand received beyond `work`
    double work = 0.0;   // [J] energy needed to lift the hand to its new rest
};

Burst burstOf(const HandModel& hand, bool controller) {
    Held held(hand, controller);
    const double start = held.rig->energyOut(), before = held.stored();
    held.moveWall(kBurst);
    const double p = std::sqrt(2.0 * before / 1000.0);
    double most = 0.0;
    for (int i = 0; i < 3000; ++i) {
        held.rig->tick();
        most = std::max(most, held.rig->energyOut() - start);
    }
    const double work = before + 1000.0 * (p * kBurst + 0.5 * kBurst * kBurst) - held.stored();
    return {most - work, work};
}

Outcome jumpBurst(RunLength) {
    double worst = -1.0, on = -1.0, off = -1.0;
    for (size_t h = 1; h < kHands.size(); ++h) {
        const Burst with = burstOf(kHands[h], true), without = burstOf(kHands[h], false);
        worst = std::max(worst, with.excess / with.work);
        on = std::max(on, with.excess);
        off = std::max(off, without.excess);
    }
    return outcomeOf(
        worst, 0.05, "1",
        "A wall jumps by 8 mm under a hand 3 mm deep: energy that the hand gets beyond the work of lifting "
        "it to its new rest, as a share of that work, worst of four hands (with and without the controller " +
            num(on * 1e3) + " and " + num(off * 1e3) +
            " mJ of 56). That work is allowed: a wall that comes nearer has to lift the hand.");
}

// The wall moves up and down by 2 mm: at 15 Hz (a jump per frame at 30 Hz), or at the hand's own frequency.
Outcome shakenWall(RunLength runLength) {
    double worst = 0.0, worstOff = 0.0, energyOn = 0.0, energyOff = 0.0;
    for (size_t h = 1; h < kHands.size(); ++h) {
        const double own = std::sqrt((1000.0 + kHands[h].stiffness) / (0.1 + kHands[h].mass)) / 6.283185307;
        for (const double rate : {15.0, std::min(own, 45.0)}) { // [Hz] full periods
            for (const bool on : {true, false}) {
                Held held(kHands[h], on);
                const double start = held.rig->time(), energy = held.rig->energyOut();
                const double seconds = runLength == RunLength::Full ? 4.0 : 1.0;
                double most = 0.0, given = 0.0;
                int flips = 0;
                while (held.rig->time() < start + seconds) {
                    if (held.rig->time() - start >= flips / (2.0 * rate)) {
                        held.moveWall(++flips % 2 == 1 ? kJump : 0.0);
                    }
                    held.rig->tick();
                    most = std::max(most, held.rise() / held.restingRise(kJump));
                    given = std::max(given, held.rig->energyOut() - energy);
                }
                (on ? worst : worstOff) = std::max(on ? worst : worstOff, most);
                (on ? energyOn : energyOff) = std::max(on ? energyOn : energyOff, given);
            }
        }
    }
    return outcomeOf(worst, 2.0, "1",
                     "A wall that jumps 2 mm up and down at 15 Hz and at the hand's own frequency: highest "
                     "rise of the hand, divided by the rise at which a single jump would hold it (a single "
                     "jump throws an undamped hand to 2, more is resonance); without the controller " +
                         num(worstOff) + " (energy into the hand at most " + num(energyOn * 1e3) +
                         " against " + num(energyOff * 1e3) + " mJ). Four hands.");
}

// The user requests springs stiffer than the passive bound.
Outcome beyondBound(RunLength runLength) {
    double worst = -1e9, worstOff = -1e9;
    size_t runs = 0;
    for (const double times : runLength == RunLength::Full ? std::vector<double>{1.5, 2.0, 3.0, 4.0}
                                                           : std::vector<double>{2.0, 4.0}) {
        LoopGrid grid;
        grid.masses = {0.1, 0.3};
        grid.dampings = {0.2, 0.5};
        grid.delays = {0, 2};
        grid.hands = {0, 1, 2, 3, 4};
        grid.every = runLength == RunLength::Full ? 1 : 7;
        runs += forEachLoop(grid, pressedSpec(Ground::Wall, 4.0), [&](LoopSpec spec) {
            spec.hand.stiffness = std::max(50.0, spec.hand.stiffness);
            spec.stiffness = times * passiveStiffness(spec.damping, 0.0, spec.period(), spec.delay);
            for (const bool on : {true, false}) {
                spec.controller = on;
                LoopRig rig(spec);
                rig.run(2.0); // right after the first touch, energy may still be owed
                double& net = on ? worst : worstOff;
                while (rig.time() < 4.0) {
                    rig.tick();
                    net = std::max(net, rig.netEnergyOut());
                }
            }
        });
    }
    Outcome out = outcomeOf(worst, 1e-6, "J",
                            "A stiffness of 1.5 to 4 times the passive bound, given by the user: net energy "
                            "out of the wall from 1.5 s after the touch on, "
                            "worst of " +
                                num(uint64_t{runs}) + " loops with the controller; without it " +
                                num(worstOff * 1e3) + " mJ.");
    require(out, worstOff > 1e-4, "without the controller there should be energy");
    return out;
}

// During a contact, ticks become 1.5 to 3 times longer than nominal.
Outcome slowTicks(RunLength runLength) {
    double worst = 0.0, fixed = 0.0, margin = 0.0;
    for (const double slow : {1.5, 2.0, 3.0}) {
        LoopGrid grid;
        grid.masses = {0.05, 0.2};
        grid.dampings = {0.2, 0.5, 2.0};
        grid.every = runLength == RunLength::Full ? 1 : 5;
        forEachLoop(grid, pressedSpec(Ground::Wall, kPressed), [&](LoopSpec spec) {
            for (const bool automatic : {true, false}) {
                spec.controller = automatic;
                spec.stiffness.reset();
                if (!automatic) {
                    spec.stiffness = loopOptions(spec, Tool(buildSphereTree(spec.leaves))).springs.stiffness;
                }
                LoopRig rig(spec);
                rig.run(kPressed);
                rig.setMeasuredPeriod(slow * spec.period());
                rig.run(0.5);
                double early = 1e-5, late = 0.0;
                for (const double end = rig.time(); rig.time() < end + 3.0;) {
                    rig.tick();
                    double& peak = rig.time() < end + 1.5 ? early : late;
                    peak = std::max(peak, glm::length(rig.hand().velocity()));
                }
                (automatic ? worst : fixed) = std::max(automatic ? worst : fixed, late / early);
                if (automatic) {
                    margin = std::min(margin, rig.last().marginPassive / spec.damping);
                }
            }
        });
    }
    Outcome out =
        outcomeOf(worst, 0.9, "1",
                  "Ticks become 1.5 to 3 times slower in contact: the automatic stiffness follows the bound "
                  "down (least passive margin then " +
                      num(margin) +
                      " b), late over early speed of the hand; with the stiffness kept and no controller " +
                      num(fixed) + ".");
    require(out, margin > -1e-6, "the measured margin should return to 0");
    return out;
}

// Impacts faster than the springs' slew limit can follow.
Outcome fastHits(RunLength runLength) {
    double net = -1e9, left = 0.0;
    size_t runs = 0;
    for (const double speed : {0.5, 1.0, 2.0, 5.0}) {
        LoopGrid grid;
        grid.dampings = {0.5, 2.0};
        grid.masses = {0.1, 0.5};
        grid.delays = {0, 1};
        grid.every = runLength == RunLength::Full ? 1 : 5;
        LoopSpec base = pressedSpec(Ground::Wall, 3.0);
        base.path = {wayAt(0.0, {0.0, 0.0, 0.2}), wayAt(0.3, {0.0, 0.0, 0.2}),
                     wayAt(0.3 + 0.22 / speed, {0.0, 0.0, -0.02})};
        runs += forEachLoop(grid, base, [&](const LoopSpec& spec) {
            const double settled = 1.0 + 20.0 * spec.wholeMass() / spec.hand.damping;
            LoopRig rig(spec);
            while (rig.time() < settled + 0.3) {
                rig.tick();
                net = rig.time() > 0.35 + 0.2 / speed ? std::max(net, rig.netEnergyOut()) : net;
                left = rig.time() > settled ? std::max(left, glm::length(rig.hand().velocity())) : left;
            }
        });
    }
    Outcome out =
        outcomeOf(net, 1e-6, "J",
                  "Hands that hit a wall at 0.5 to 5 m/s, faster than the force may rise (2000 N/s): net "
                  "energy out of the wall at any time after "
                  "the hit, worst of " +
                      num(uint64_t{runs}) + " loops; fastest left at the end " + num(left * 1e3) + " mm/s.");
    require(out, left < 2e-3, "the hand should come to rest");
    return out;
}

} // namespace

std::vector<Case> controllerCases() {
    return {{"moving-fixture-energy-is-counted", Group::Stiff, injectionCounted},
            {"moving-fixture-burst-is-damped", Group::Stiff, jumpBurst},
            {"shaken-fixture-does-not-throw-the-hand", Group::Stiff, shakenWall},
            {"stiffness-beyond-the-bound-is-tamed", Group::Stiff, beyondBound},
            {"slow-turns-lower-the-stiffness", Group::Stiff, slowTicks},
            {"hits-faster-than-the-slew-limit", Group::Stiff, fastHits}};
}

} // namespace fathom::stability
