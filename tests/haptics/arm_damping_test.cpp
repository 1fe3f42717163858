// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_damping.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

using namespace fathom;

namespace {

using Vectors = std::vector<std::vector<double>>;

// `count` orthonormal vectors of the given dimension.
Vectors orthogonal(size_t count, std::mt19937& random) {
    std::normal_distribution<double> any;
    Vectors all;
    while (all.size() < count) {
        std::vector<double> v(count);
        std::generate(v.begin(), v.end(), [&] { return any(random); });
        for (int pass = 0; pass < 2; ++pass) {
            for (const auto& u : all) {
                double along = 0.0;
                for (size_t i = 0; i < count; ++i) {
                    along += u[i] * v[i];
                }
                for (size_t i = 0; i < count; ++i) {
                    v[i] -= along * u[i];
                }
            }
        }
        double square = 0.0;
        for (const double x : v) {
            square += x * x;
        }
        for (double& x : v) {
            x /= std::sqrt(square);
        }
        all.push_back(v);
    }
    return all;
}

// Columns with the given singular values; further joints have zero columns.
ArmNormal withSingulars(size_t joints, const std::vector<double>& values, std::mt19937& random) {
    const Vectors left = orthogonal(6, random), right = orthogonal(joints, random);
    ArmNormal normal(joints);
    for (size_t k = 0; k < joints; ++k) {
        std::vector<double> column(6, 0.0);
        for (size_t i = 0; i < values.size(); ++i) {
            for (size_t row = 0; row < 6; ++row) {
                column[row] += values[i] * right[i][k] * left[i][row];
            }
        }
        normal.addColumn(k, dvec3(column[0], column[1], column[2]), dvec3(column[3], column[4], column[5]));
    }
    return normal;
}

} // namespace

TEST_CASE("The smallest singular value is exact for 1 to 12 joints, down to 1e-6 of the largest") {
    std::mt19937 random(7);
    for (size_t joints = 1; joints <= kMaxJoints; ++joints) {
        for (const double ratio : {1.0, 0.3, 1e-2, 1e-4, 1e-6}) {
            for (int draw = 0; draw < 20; ++draw) {
                std::vector<double> values(std::min<size_t>(joints, 6), 1.7);
                const double step =
                    std::pow(ratio, 1.0 / std::max(1.0, static_cast<double>(values.size()) - 1.0));
                for (size_t i = 1; i < values.size(); ++i) {
                    values[i] = values[i - 1] * step;
                }
                const double found = withSingulars(joints, values, random).smallestSingular();
                CAPTURE(joints);
                CAPTURE(ratio);
                CAPTURE(found - values.back());
                // The Gram matrix has the rounding of the largest value's square.
                CHECK(std::abs(found * found - values.back() * values.back()) <=
                      2e-15 * values[0] * values[0]);
            }
        }
    }
}

TEST_CASE("The smallest singular value is 0 for zero columns and for an arm whose joints are all locked") {
    ArmNormal still(3);
    CHECK(still.smallestSingular() == 0.0);
    ArmNormal locked(1);
    locked.addColumn(0, dvec3(1.0, 0.0, 0.0), dvec3(0.0));
    locked.exclude(0);
    CHECK(locked.smallestSingular() == 0.0);
}
