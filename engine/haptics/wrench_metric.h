// SPDX-License-Identifier: Apache-2.0
// The norm in which a spring wrench is K_t times the metric distance: torque counts as torque / k, k [m] the
// metric radius.
#pragma once

#include "engine/types/wrench.h"

#include <cmath>

namespace fathom {

inline constexpr double kMinFelt = 1e-3; // [N] a smaller wrench is not felt and has no direction

// f1 f2 + tau1 tau2 / k^2 [N^2]
inline double metricProduct(const Wrench& a, const Wrench& b, double k) noexcept {
    return glm::dot(a.force, b.force) + glm::dot(a.torque, b.torque) / (k * k);
}

// [N]
inline double metricSize(const Wrench& wrench, double k) noexcept {
    return std::sqrt(metricProduct(wrench, wrench, k));
}

// a + factor b
inline Wrench sumOf(const Wrench& a, const Wrench& b, double factor = 1.0) noexcept {
    return {a.force + factor * b.force, a.torque + factor * b.torque};
}

} // namespace fathom
