// SPDX-License-Identifier: Apache-2.0
// A scripted hand without manners: it is drawn about an arena, leaps, spins and turns over.
#pragma once

#include "apps/stability/rng.h"
#include "engine/types/pose.h"

#include <algorithm>

namespace fathom::stability {

struct HandMotion {
    double speed = 0.5;     // [m/s] at most
    double spin = 20.0;     // [rad/s] at most, about any axis
    double leaps = 2.0;     // a second, to anywhere within `leap`
    double leap = 10.0;     // [m]
    double hops = 8.0;      // a second, to anywhere in the arena
    double turnOvers = 0.0; // a second: 180 degrees at once about any axis
};

// Deterministic: the same poses from the same seed.
class RandomHand {
public:
    // arena: half edge of the cube about `focus` that it is drawn to [m].
    RandomHand(const Pose& start, const dvec3& focus, double arena, const HandMotion& motion, uint64_t seed)
        : pose_(start)
        , focus_(focus)
        , arena_(arena)
        , motion_(motion)
        , rng_(seed) {}

    // The pose a turn of `period` [s] later.
    Pose next(double period) {
        if (rng_.chance(20.0 * period) || way_ == dvec3(0.0)) { // off to some other place
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
            pose_.rotation = rotationExp(3.141592653589793 * rng_.direction()) * pose_.rotation;
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
