// SPDX-License-Identifier: Apache-2.0
// Group stiff, part one: the largest stable stiffness, measured with the full loop, against theory.
#include "apps/stability/boundary.h"
#include "apps/stability/case_text.h"
#include "apps/stability/stiff_cases.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::stability {

namespace {

struct Grid {
    std::vector<double> masses, dampings, rates;
    std::vector<uint32_t> delays;
    std::vector<double> virtualDampings;
};

struct Deviation {
    double fromModel = 0.0, fromLaw = 0.0; // largest relative deviations
    size_t runs = 0;
    std::vector<std::array<double, 3>> points; // law, measured / model, measured / law
};

void measureOne(const LoopSpec& spec, bool rotational, Deviation& all) {
    const double kk = rotational ? spec.armLength * spec.armLength : 1.0;
    const double law = lawOfBoundary(spec.damping, spec.virtualDamping, spec.period(), spec.delay) * kk;
    const SampledLoop model{spec.wholeMass(), spec.wholeDamping(), spec.hand.stiffness,
                            spec.period(),    spec.virtualDamping, spec.delay};
    const double computed = computedBoundary(model, law / kk) * kk;
    const double measured = measuredBoundary(spec, law, rotational);
    all.fromModel = std::max(all.fromModel, std::abs(measured / computed - 1.0));
    all.fromLaw = std::max(all.fromLaw, std::abs(measured / law - 1.0));
    ++all.runs;
    all.points.push_back({law, measured / computed, measured / law});
}

Deviation measure(const Grid& grid, bool rotational = false) {
    Deviation all;
    for (const double rate : grid.rates) {
        for (const double mass : grid.masses) {
            for (const uint32_t delay : grid.delays) {
                for (const double b : grid.dampings) {
                    for (const double virtualDamping : grid.virtualDampings) {
                        LoopSpec spec;
                        spec.mass = mass;
                        spec.damping = b;
                        spec.rateHz = rate;
                        spec.delay = delay;
                        spec.virtualDamping = virtualDamping;
                        measureOne(spec, rotational, all);
                    }
                }
            }
        }
    }
    return all;
}

Outcome against(const Deviation& all, bool byModel, double limit, const std::string& what) {
    Outcome out =
        outcomeOf(byModel ? all.fromModel : all.fromLaw, limit, "1",
                  what + " " + std::to_string(all.runs) +
                      " boundaries by bisection; farthest from the exact discrete model " +
                      num(all.fromModel) + ", from the law K = (b + B)/(T/2 + nT) " + num(all.fromLaw) + ".");
    Outcome::Curve model{"measured / exact model", "K_max by the law", "ratio", {}, {}, true, false};
    Outcome::Curve law = model;
    law.name = "measured / law";
    std::vector<std::array<double, 3>> points = all.points;
    std::sort(points.begin(), points.end());
    for (const auto& [k, overModel, overLaw] : points) {
        model.x.push_back(k);
        model.y.push_back(overModel);
        law.x.push_back(k);
        law.y.push_back(overLaw);
    }
    out.curves = {model, law};
    return out;
}

Outcome freeDevice(RunLength runLength) {
    Grid grid{{0.05, 0.2, 1.0}, {0.1, 0.2, 0.5, 1.0, 2.0}, {1000.0}, {0}, {0.0}};
    if (runLength == RunLength::Short) {
        grid.masses = {0.2}, grid.dampings = {0.1, 0.5, 2.0};
    }
    return against(measure(grid), false, 0.01,
                   "Free device of 0.05-1 kg and 0.1-2 N s/m at 1 kHz on a line; the law's own accuracy is b "
                   "T/(6 m), at most 0.7 % here.");
}

Outcome delays(RunLength runLength) {
    Grid grid{{0.1, 0.25, 1.0}, {0.1, 0.5, 2.0}, {1000.0}, {1, 2, 3}, {0.0}};
    if (runLength == RunLength::Short) {
        grid.masses = {0.25}, grid.dampings = {0.5}, grid.delays = {1, 3};
    }
    return against(measure(grid), true, 0.005, "One to three ticks of delay, 0.1-1 kg, 0.1-2 N s/m.");
}

Outcome rates(RunLength runLength) {
    Grid grid{{0.2, 1.0}, {0.2, 1.0}, {500.0, 2000.0, 4000.0, 10000.0}, {0, 1}, {0.0}};
    if (runLength == RunLength::Short) {
        grid.masses = {0.2}, grid.dampings = {1.0}, grid.rates = {500.0, 10000.0}, grid.delays = {0};
    }
    return against(measure(grid), true, 0.005, "500 Hz to 10 kHz, with and without a tick of delay.");
}

Outcome virtualDamping(RunLength runLength) {
    Grid grid{{0.1, 0.25}, {0.5, 1.0}, {1000.0}, {0, 1}, {0.25, 1.0, 2.0, 5.0}};
    if (runLength == RunLength::Short) {
        grid.masses = {0.25}, grid.dampings = {0.5}, grid.virtualDampings = {2.0}, grid.delays = {0};
    }
    return against(measure(grid), true, 0.01,
                   "With virtual damping B up to ten times b: stable well above the passive bound (b > KT/2 "
                   "+ |B|); the two margins report them separately.");
}

Outcome rotation(RunLength runLength) {
    Grid grid{{0.1, 0.5}, {0.1, 0.5, 2.0}, {1000.0, 4000.0}, {0, 1}, {0.0}};
    if (runLength == RunLength::Short) {
        grid.masses = {0.1}, grid.dampings = {0.5}, grid.rates = {1000.0}, grid.delays = {0, 1};
    }
    return against(measure(grid, true), true, 0.005,
                   "The same law for K_r and b_r: a device that swings about an axis, 0.001-0.005 kg m^2.");
}

// No hand makes a passive loop unstable: with every hand, the boundary is at or above the passive bound.
Outcome hands(RunLength runLength) {
    double least = 1e9;
    std::string worst;
    size_t runs = 0;
    for (const HandModel& hand : kHands) {
        for (const double b :
             runLength == RunLength::Full ? std::vector<double>{0.1, 0.5, 2.0} : std::vector<double>{0.5}) {
            for (const uint32_t delay : runLength == RunLength::Full ? std::vector<uint32_t>{0, 1, 3}
                                                                     : std::vector<uint32_t>{0, 1}) {
                LoopSpec spec;
                spec.damping = b;
                spec.hand = hand;
                spec.delay = delay;
                const double bound = passiveStiffness(b, 0.0, spec.period(), delay);
                const double ratio = measuredBoundary(spec, bound) / bound;
                ++runs;
                if (ratio < least) {
                    least = ratio;
                    worst = hand.name;
                }
            }
        }
    }
    Outcome out = outcomeOf(least, 0.98, "1",
                            "Measured boundary over the passive bound, least of " + std::to_string(runs) +
                                " loops from a free device to a firm grip (" + worst +
                                "): b > KT(1 + 2n)/2 is enough in any hand; 2 % for the light device's own "
                                "deviation (b T/(6 m)) and the bisection.");
    out.relation = ">=";
    return out;
}

} // namespace

std::vector<Case> boundaryCases() {
    return {{"stiffness-limit-free-device", Group::Stiff, freeDevice},
            {"stiffness-limit-with-delay", Group::Stiff, delays},
            {"stiffness-limit-500-hz-to-10-khz", Group::Stiff, rates},
            {"stiffness-limit-with-virtual-damping", Group::Stiff, virtualDamping},
            {"stiffness-limit-in-rotation", Group::Stiff, rotation},
            {"stiffness-limit-with-every-hand", Group::Stiff, hands}};
}

} // namespace fathom::stability
