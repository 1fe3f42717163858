// SPDX-License-Identifier: Apache-2.0
// A scripted hand that moves violently: it wanders through an arena, leaps, spins and flips over.
#pragma once

#include "engine/reference/rng.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <numbers>

namespace fathom::stability {

struct HandMotion {
    double speed = 0.5;     // [m/s] maximum
    double spin = 20.0;     // [rad/s] maximum, about any axis
    double leaps = 2.0;     // per second, to any point within `leap`
    double leap = 10.0;     // [m]
    double hops = 8.0;      // per second, to any point in the arena
    double turnOvers = 0.0; // per second, 180 degrees at once about any axis
};

// Deterministic: the same seed gives the same poses.
class RandomHand {
public:
    // arena: half edge [m] of the cube around `focus` in which the hand moves.
    RandomHand(const Pose& start, const dvec3& focus, double arena, const HandMotion& motion, uint64_t seed)
        : pose_(start)
        , focus_(focus)
        , arena_(arena)
        , motion_(motion)
        , rng_(seed) {}

    // The pose one tick of `period` [s] later.
    Pose next(double period) {
        if (rng_.chance(20.0 * period) || way_ == dvec3(0.0)) { // choose a new direction
            const dvec3 wanted = focus_ + rng_.inCube(arena_) - pose_.position;
            way_ = wanted * (motion_.speed * rng_.uniform(0.5, 1.0) / std::max(1e-9, glm::length(wanted)));
            spin_ = motion_.spin * rng_.uniform(0.5, 1.0) * rng_.direction();
        }
        if (rng_.chance(motion_.leaps * period)) {
            pose_ = {focus_ + rng_.inCube(motion_.leap), rng_.rotation()};
        } else if (rng_.chance(motion_.hops * period)) {
            pose_.position = focus_ + rng_.inCube(arena_);
        }
        if (rng_.chance(motion_.turnOvers * period)) {
            pose_.rotation = rotationExp(std::numbers::pi * rng_.direction()) * pose_.rotation;
        }
        pose_.position += way_ * period;
        pose_.rotation = glm::normalize(rotationExp(spin_ * period) * pose_.rotation);
        return pose_;
    }

private:
    Pose pose_;
    dvec3 focus_;
    double arena_;
    HandMotion motion_;
    Rng rng_;
    dvec3 way_{0.0}, spin_{0.0};
};

} // namespace fathom::stability
