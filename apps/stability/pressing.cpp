// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/pressing.h"

#include "apps/stability/case_text.h"

namespace fathom::stability {

LoopSpec pressedSpec(Ground ground, double seconds) {
    LoopSpec spec;
    dvec3 above(0.0, 0.0, 0.02), pressed(0.0, 0.0, -0.005), slid(0.02, 0.0, -0.005);
    switch (ground) {
    case Ground::Wall:
        spec.shapes = {wallShape({0.0, 0.0, 1.0}, 0.0)};
        break;
    case Ground::Corner:
        spec.shapes = {wallShape({0.0, 0.0, 1.0}, 0.0), wallShape({1.0, 0.0, 0.0}, 0.0),
                       wallShape({0.0, 1.0, 0.0}, 0.0)};
        above = {0.02, 0.02, 0.02}, pressed = {-0.005, -0.005, -0.005}, slid = {0.015, -0.005, -0.005};
        break;
    case Ground::Slot: // 0.5 mm of clearance on each side
        spec.shapes = {wallShape({0.0, 0.0, 1.0}, 0.0), wallShape({1.0, 0.0, 0.0}, -0.0105),
                       wallShape({-1.0, 0.0, 0.0}, -0.0105)};
        pressed = {0.006, 0.0, -0.005}, slid = {-0.006, 0.02, -0.005};
        break;
    case Ground::Spheres:
        spec.fixtures = sphereWall(0.0, 1);
        break;
    }
    const double down = 0.3 + 0.25;
    spec.path = {wayAt(0.0, above),          wayAt(0.3, above),       wayAt(down, pressed),
                 wayAt(down + 0.1, pressed), wayAt(down + 0.3, slid), wayAt(seconds, slid)};
    return spec;
}

size_t forEachLoop(const LoopGrid& grid, const LoopSpec& base,
                   const std::function<void(const LoopSpec&)>& use) {
    size_t count = 0, used = 0;
    for (const double rate : grid.rates) {
        for (const double mass : grid.masses) {
            for (const double b : grid.dampings) {
                for (const uint32_t delay : grid.delays) {
                    for (const size_t hand : grid.hands) {
                        if (count++ % grid.every != 0) {
                            continue;
                        }
                        LoopSpec spec = base;
                        spec.rateHz = rate;
                        spec.mass = mass;
                        spec.damping = b;
                        spec.delay = delay;
                        spec.hand = kHands[hand];
                        use(spec);
                        ++used;
                    }
                }
            }
        }
    }
    return used;
}

std::string nameOf(const LoopSpec& spec) {
    return std::string(spec.hand.name) + ", " + num(spec.mass) + " kg, " + num(spec.damping) + " N s/m, " +
           num(uint64_t{spec.delay}) + " ticks, " + num(spec.rateHz) + " Hz";
}

} // namespace fathom::stability
