// SPDX-License-Identifier: Apache-2.0
// Random row sets for the solver: typical ones of a sphere tool, and degenerate ones that break solvers.
#pragma once

#include "engine/haptics/constraint_solver.h"
#include "engine/reference/kkt.h"
#include "engine/types/pose.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fathom {

class Random {
public:
    explicit Random(uint64_t seed)
        : engine_(seed) {}
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    size_t below(size_t n) { return engine_() % n; }
    double normal() {
        return std::sqrt(-2.0 * std::log(uniform(1e-300, 1.0))) *
               std::cos(6.283185307179586 * uniform(0.0, 1.0));
    }
    dvec3 direction() { return glm::normalize(dvec3(normal(), normal(), normal())); }

private:
    std::mt19937_64 engine_;
};

enum class SetKind {
    Generic,
    Feasible,
    FlatWall,
    Groove,
    Needle,
    Corner,
    OpposingWalls,
    Duplicates,
    NearParallel,
    Contacts
};
inline constexpr int kSetKinds = 10;

struct ConstraintSet {
    size_t n = 6;
    std::vector<double> metric, target, normals, offsets;

    size_t rows() const { return offsets.size(); }
    std::span<const double> normal(size_t row) const { return std::span(normals).subspan(row * n, n); }
    NearestPointProblem problem() const { return {n, metric, target, normals, offsets}; }
    void add(const std::vector<double>& row, double offset) {
        normals.insert(normals.end(), row.begin(), row.end());
        offsets.push_back(offset);
    }
    // [normal; arm x normal] for 6 unknowns, truncated for fewer, padded with zeros for more.
    void addContact(const dvec3& normalOut, const dvec3& arm, double offset) {
        const dvec3 moment = glm::cross(arm, normalOut);
        std::vector<double> row{normalOut.x, normalOut.y, normalOut.z, moment.x,
                                moment.y,    moment.z,    0.0,         0.0};
        row.resize(n);
        add(row, offset);
    }
};

inline std::vector<double> freeToolMetric(size_t n, double k) {
    std::vector<double> metric(n * n, 0.0);
    for (size_t i = 0; i < n; ++i) {
        metric[i * n + i] = i < 3 ? 1.0 : k * k;
    }
    return metric;
}

// A A^T + small I: symmetric, positive definite, condition up to 1 / floor.
inline std::vector<double> randomMetric(size_t n, double floor, Random& random) {
    std::vector<double> a(n * n), metric(n * n, 0.0);
    for (double& value : a) {
        value = random.normal();
    }
    for (size_t i = 0; i < n; ++i) {
        for (size_t j = 0; j <= i; ++j) {
            double sum = i == j ? floor : 0.0;
            for (size_t k = 0; k < n; ++k) {
                sum += a[i * n + k] * a[j * n + k];
            }
            metric[i * n + j] = metric[j * n + i] = sum;
        }
    }
    return metric;
}

inline dvec3 randomArm(Random& random) {
    return {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
}

// Offsets are below 2 mm. When the set must be feasible, a point of 1 mm length satisfies them.
inline void addRow(ConstraintSet& set, SetKind kind, size_t index, Random& random) {
    const dvec3 noise = random.direction();
    const dvec3 arm = randomArm(random);
    const double gap = random.uniform(-0.002, 0.0005);
    switch (kind) {
    case SetKind::FlatWall:
        set.addContact(glm::normalize(dvec3(0, 0, 1) + 1e-3 * noise), arm, gap);
        break;
    case SetKind::Groove: { // opening of 0.1 degree: each wall is 0.05 degree from opposing the other
        const double lean = 8.7266e-4, side = index % 2 == 0 ? 1.0 : -1.0;
        set.addContact({side * std::cos(lean), 0.0, std::sin(lean)}, {0.0, arm.y, 0.0}, gap);
        break;
    }
    case SetKind::Needle: {
        const double angle = random.uniform(0.0, 6.283);
        set.addContact({std::cos(angle), std::sin(angle), 0.01 * noise.z}, {0.0, 0.0, arm.z}, gap);
        break;
    }
    case SetKind::Corner: {
        dvec3 axis(0.0);
        axis[static_cast<int>(index % 3)] = 1.0;
        set.addContact(glm::normalize(axis + 0.01 * noise), arm, gap);
        break;
    }
    case SetKind::OpposingWalls:
        set.addContact({0.0, 0.0, index % 2 == 0 ? 1.0 : -1.0}, {0.0, 0.0, 0.0},
                       index % 4 == 3 ? gap : -std::abs(gap));
        break;
    case SetKind::NearParallel: {
        const dvec3 about = glm::normalize(dvec3(0.3, -0.2, static_cast<double>(index % 5) - 1.7));
        set.addContact(glm::normalize(about + 1e-9 * noise), {0.01, 0.02, 0.03}, gap);
        break;
    }
    default:
        set.addContact(random.direction(), arm, gap);
    }
}

// Sets the offset of the newest row as its kind requires.
inline void settleOffset(ConstraintSet& set, SetKind kind, const std::vector<double>& inside,
                         Random& random) {
    const size_t index = set.rows() - 1, up = set.n > 2 ? 2 : 0;
    if (kind == SetKind::Feasible || kind == SetKind::Duplicates) {
        double along = 0.0;
        for (size_t j = 0; j < set.n; ++j) {
            along += set.normal(index)[j] * inside[j];
        }
        set.offsets.back() = along - random.uniform(0.0, 1e-3);
    }
    if (kind == SetKind::Contacts) { // a tool pressed on a relief: most rows are slack
        set.offsets.back() = index < 3 ? 0.0 : -random.uniform(0.0, 0.004);
        set.normals[index * set.n + up] = std::abs(set.normal(index)[up]) + 1.0;
    }
}

inline ConstraintSet makeSet(SetKind kind, size_t n, size_t rows, double k, Random& random) {
    ConstraintSet set;
    set.n = n;
    set.metric = n == 8 || n == 1 ? randomMetric(n, 1e-4, random) : freeToolMetric(n, k);
    std::vector<double> inside(n), row(n);
    for (size_t i = 0; i < n; ++i) {
        set.target.push_back(random.uniform(-1.0, 1.0) * (i < 3 ? 0.01 : 0.1));
        inside[i] = random.uniform(-1e-3, 1e-3);
    }
    while (set.rows() < rows) {
        const size_t index = set.rows();
        if (kind == SetKind::Duplicates && index > 0 && random.below(2) == 0) {
            const size_t copy = random.below(index);
            const auto same = set.normal(copy);
            const std::vector<double> twin(same.begin(), same.end());
            set.add(twin, set.offsets[copy] - (random.below(2) == 0 ? 0.0 : 1e-4));
            continue;
        }
        if (n == 8 || n == 1) {
            for (double& value : row) {
                value = random.normal();
            }
            set.add(row, random.uniform(-0.002, 0.0005));
        } else {
            addRow(set, kind, index, random);
        }
        settleOffset(set, kind, inside, random);
    }
    return set;
}

inline void load(ConstraintSolver& solver, const ConstraintSet& set) {
    solver.setMetric(set.metric);
    solver.clearRows();
    for (size_t i = 0; i < set.rows(); ++i) {
        solver.addRow(set.normal(i), set.offsets[i]);
    }
}

} // namespace fathom
