// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/counter_noise.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// x with P(X < x) = share of a standard normal, by Newton from 0; share in (0, 0.5].
double normalQuantile(double share) {
    double x = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double error = 0.5 * std::erfc(-x / std::sqrt(2.0)) - share;
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::acos(-1.0));
        x -= std::clamp(error / density, -0.5, 0.5);
    }
    return x;
}

} // namespace

NormalTable::NormalTable() {
    for (uint32_t i = 0; i <= 512; ++i) {
        const double share = i == 0 ? 0.5 / 1024.0 : i / 1024.0; // the outermost edge closes the table
        edges_[i] = static_cast<float>(normalQuantile(share));
        edges_[1024 - i] = -edges_[i];
    }
    // The cut tails and the straight lines between the edges change the variance: put it back to 1.
    double square = 0.0;
    for (uint32_t i = 0; i < 1024; ++i) {
        const double a = edges_[i], b = edges_[i + 1];
        square += (a * a + a * b + b * b) / 3.0 / 1024.0;
    }
    for (float& edge : edges_) {
        edge = static_cast<float>(edge / std::sqrt(square));
    }
    for (size_t i = 0; i < middles_.size(); ++i) {
        middles_[i] = 0.5f * (edges_[i] + edges_[i + 1]);
    }
}

} // namespace fathom
