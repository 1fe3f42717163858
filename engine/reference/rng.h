// SPDX-License-Identifier: Apache-2.0
// Random numbers for tests and cases. A seed gives the same sequence with every compiler and library.
#pragma once

#include "engine/types/angle.h"
#include "engine/types/pose.h"

#include <cmath>
#include <cstdint>
#include <random>

namespace fathom {

class Rng {
public:
    explicit Rng(uint64_t seed)
        : engine_(seed) {}

    double uniform(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double logUniform(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
    size_t below(size_t n) { return engine_() % n; }
    bool chance(double share) { return uniform(0.0, 1.0) < share; }
    double normal() {
        const double length = std::sqrt(-2.0 * std::log(uniform(1e-300, 1.0)));
        return length * std::cos(kTurn * uniform(0.0, 1.0));
    }
    dvec3 direction() {
        const double x = normal(), y = normal();
        return glm::normalize(dvec3(x, y, normal()));
    }
    dvec3 inCube(double half) {
        const double x = uniform(-half, half), y = uniform(-half, half);
        return {x, y, uniform(-half, half)};
    }
    dquat rotation() {
        const double w = normal(), x = normal(), y = normal();
        return glm::normalize(dquat(w, x, y, normal()));
    }

private:
    std::mt19937_64 engine_;
};

} // namespace fathom
