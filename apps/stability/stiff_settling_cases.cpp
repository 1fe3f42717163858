// SPDX-License-Identifier: Apache-2.0
// Group stiff, part two: with the automatic stiffness nothing oscillates, for all devices, hands, delays,
// rates and encoders.
#include "apps/stability/case_text.h"
#include "apps/stability/pressing.h"
#include "apps/stability/stiff_cases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::stability {

namespace {

// Peak speed of the hand in a late window over that in an early one. Both windows are longer than the slowest
// swing.
double swingRatio(LoopSpec spec, double& residual) {
    const double window =
        std::max(0.3, 3.0 * std::numbers::pi / std::sqrt(spec.hand.stiffness / spec.wholeMass()));
    spec.path.back().t = kPressed + 2.0 * window;
    LoopRig rig(spec);
    rig.run(kPressed);
    double early = 0.0, late = 0.0;
    while (rig.time() < kPressed + 2.0 * window) {
        rig.tick();
        const double speed = glm::length(rig.hand().velocity());
        double& peak = rig.time() < kPressed + window ? early : late;
        peak = std::max(peak, speed);
    }
    residual = late;
    return late / std::max(early, 1e-5); // below 10 um/s counts as rest
}

Outcome settles(Ground ground, const LoopGrid& grid, const std::string& where) {
    double worst = 0.0, residual = 0.0;
    std::string who;
    const size_t runs = forEachLoop(grid, pressedSpec(ground, kPressed), [&](const LoopSpec& spec) {
        double left = 0.0;
        const double ratio = swingRatio(spec, left);
        residual = std::max(residual, left);
        if (!(ratio <= worst)) {
            worst = ratio;
            who = nameOf(spec);
        }
    });
    return outcomeOf(worst, 0.9, "1",
                     where + " Fastest speed of the hand in a later window over an earlier one, worst of " +
                         num(uint64_t{runs}) + " loops (" + who + "); fastest left at the end " +
                         num(residual * 1e3) + " mm/s. 1 would be a sustained oscillation.");
}

LoopGrid settlingGrid(RunLength runLength, size_t every) {
    LoopGrid grid;
    grid.every = runLength == RunLength::Full ? 1 : every;
    return grid;
}

Outcome walls(RunLength runLength) {
    return settles(Ground::Wall, settlingGrid(runLength, 7), "A wall.");
}
Outcome corners(RunLength runLength) {
    return settles(Ground::Corner, settlingGrid(runLength, 11), "A corner of three walls.");
}
Outcome slots(RunLength runLength) {
    return settles(Ground::Slot, settlingGrid(runLength, 11),
                   "A slot with 0.5 mm of room on each side, slid from one side to the other.");
}
Outcome spheres(RunLength runLength) {
    LoopGrid grid = settlingGrid(runLength, 19);
    grid.delays = {0, 2};
    return settles(Ground::Spheres, grid, "A wall of region spheres with 0.05 mm dimples.");
}
Outcome settlingRates(RunLength runLength) {
    LoopGrid grid = settlingGrid(runLength, 13);
    grid.rates = {500.0, 2000.0, 4000.0, 10000.0};
    grid.delays = {0, 2};
    grid.masses = {0.05, 1.0};
    return settles(Ground::Wall, grid, "500 Hz to 10 kHz.");
}

// Only the device itself has damping, and the passive bound uses all of it. So the hand's undamped spring
// bounces for ever, but must not bounce higher.
Outcome bounces(RunLength runLength) {
    double worst = 0.0;
    LoopGrid grid;
    grid.hands = {0};
    grid.every = runLength == RunLength::Full ? 1 : 4;
    grid.masses = {0.05, 0.1, 0.2, 0.5, 1.0};
    LoopSpec base = pressedSpec(Ground::Wall, 4.0);
    base.limited = false;
    base.path = {wayAt(0.0, {0.0, 0.0, 0.005}), wayAt(1e-9, {0.0, 0.0, 0.008})};
    const size_t runs = forEachLoop(grid, base, [&](LoopSpec spec) {
        spec.hand.stiffness = 50.0;
        LoopRig rig(spec);
        rig.run(0.25);
        double early = 0.0, late = 0.0;
        while (rig.time() < 4.0) {
            rig.tick();
            const double z = std::abs(rig.hand().handle().position.z - 0.008);
            (rig.time() < 1.5 ? early : late) =
                std::max(rig.time() < 1.5 ? early : late, rig.time() < 1.5 || rig.time() > 2.75 ? z : 0.0);
        }
        worst = std::max(worst, late / early);
    });
    return outcomeOf(worst, 1.001, "1",
                     "A free device pushed by a spring of 50 N/m without damping: height of the bounces "
                     "after 2.75 s divided by that before 1.5 s, worst of " +
                         num(uint64_t{runs}) + " (0.05-1 kg, 0.1-2 N s/m, 0-3 ticks).");
}

// Residual motion of the hand at rest, in encoder steps.
Outcome encoders(RunLength runLength) {
    double worst = 0.0;
    std::string who;
    Outcome::Curve curve{"hand at rest", "encoder step [m]", "peak to peak [m]", {}, {}, true, true};
    size_t runs = 0;
    for (const double step : {1e-6, 1e-5, 5e-5, 1e-4}) {
        LoopGrid grid = settlingGrid(runLength, 17);
        LoopSpec base = pressedSpec(Ground::Wall, 3.0);
        base.encoderStep = step;
        double largest = 0.0;
        runs += forEachLoop(grid, base, [&](const LoopSpec& spec) {
            const double settled = kPressed + 30.0 * spec.wholeMass() / spec.hand.damping;
            LoopSpec held = spec;
            held.path.back().t = settled + 0.5;
            LoopRig rig(held);
            rig.run(settled);
            dvec3 lo(1e9), hi(-1e9);
            for (double end = rig.time() + 0.5; rig.time() < end;) {
                rig.tick();
                lo = glm::min(lo, rig.hand().handle().position);
                hi = glm::max(hi, rig.hand().handle().position);
            }
            const double swing = glm::length(hi - lo);
            largest = std::max(largest, swing);
            if (swing / step > worst) {
                worst = swing / step;
                who = nameOf(spec) + ", " + num(step * 1e6) + " um";
            }
        });
        curve.x.push_back(step);
        curve.y.push_back(largest);
    }
    Outcome out = outcomeOf(worst, 2.0, "steps",
                            "Encoder steps of 1 um to 0.1 mm: peak-to-peak motion of the hand, in encoder "
                            "steps, when it should be at rest; worst of " +
                                num(uint64_t{runs}) + " loops (" + who +
                                "). 0 is impossible: without friction the loop cannot know where inside a "
                                "step the hand is; it may move one step to either side of a border.");
    out.curves.push_back(std::move(curve));
    return out;
}

// The low-pass filter counts as delay.
Outcome lowPass(RunLength runLength) {
    double worst = 0.0;
    size_t runs = 0;
    for (const double hz : {30.0, 100.0, 300.0}) {
        LoopGrid grid = settlingGrid(runLength, 13);
        grid.delays = {0, 1};
        LoopSpec base = pressedSpec(Ground::Wall, kPressed);
        base.lowPassHz = hz;
        runs += forEachLoop(grid, base, [&](const LoopSpec& spec) {
            double left = 0.0;
            worst = std::max(worst, swingRatio(spec, left));
        });
    }
    return outcomeOf(worst, 0.9, "1",
                     "Low-pass of 30, 100 and 300 Hz in the chain, with and without a tick of delay: late "
                     "speed divided by early speed, worst of " +
                         num(uint64_t{runs}) + " loops.");
}

} // namespace

std::vector<Case> settlingCases() {
    return {{"automatic-stiffness-settles-on-walls", Group::Stiff, walls},
            {"automatic-stiffness-settles-in-corners", Group::Stiff, corners},
            {"automatic-stiffness-settles-in-slots", Group::Stiff, slots},
            {"automatic-stiffness-settles-on-spheres", Group::Stiff, spheres},
            {"automatic-stiffness-500-hz-to-10-khz", Group::Stiff, settlingRates},
            {"automatic-stiffness-with-low-pass", Group::Stiff, lowPass},
            {"free-device-never-bounces-higher", Group::Stiff, bounces},
            {"encoder-steps-do-not-shake-the-hand", Group::Stiff, encoders}};
}

} // namespace fathom::stability
