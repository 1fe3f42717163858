// SPDX-License-Identifier: Apache-2.0
// The row store: the dispatched scan against a plain loop, degenerate rows, offsets, and edge cases of the
// solver.
#include "tests/haptics/allocation_count.h"
#include "tests/haptics/constraint_sets.h"

#include "engine/types/error.h"

#include <doctest/doctest.h>

#include <array>
#include <limits>

using namespace fathom;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

MetricFactor identityFactor() {
    MetricFactor factor;
    factor.inverseDiagonal.fill(1.0);
    for (size_t i = 0; i < kMaxUnknowns; ++i) {
        factor.lower[i * kMaxUnknowns + i] = 1.0;
    }
    return factor;
}

ConstraintSolver identitySolver(int n, size_t maxRows) {
    ConstraintSolver solver(n, maxRows);
    std::vector<double> metric(static_cast<size_t>(n * n), 0.0);
    for (int i = 0; i < n; ++i) {
        metric[static_cast<size_t>(i * n + i)] = 1.0;
    }
    solver.setMetric(metric);
    return solver;
}

} // namespace

TEST_CASE("The scan finds the same row and the same bits as a plain loop on every instruction set") {
    Rng random(3);
    for (const int n : {1, 2, 3, 4, 5, 6, 7, 8}) {
        for (const size_t count : {1, 7, 8, 9, 63, 64, 513}) {
            ConstraintRows rows(n, 513);
            std::vector<double> row(static_cast<size_t>(n));
            for (size_t i = 0; i < count; ++i) {
                for (double& value : row) {
                    value = random.normal();
                }
                REQUIRE(rows.add(row, random.uniform(-1.0, 1.0)));
            }
            rows.prepare(identityFactor());
            ScaledVector y{};
            for (int j = 0; j < n; ++j) {
                y[j] = random.normal();
            }
            double amount = 1e-13;
            size_t worst = count;
            for (size_t i = 0; i < count; ++i) {
                ScaledVector unit;
                rows.unitRow(i, unit.data());
                CHECK(dot(unit, unit) == doctest::Approx(1.0).epsilon(1e-15));
                double violation = rows.bound(i);
                for (int j = 0; j < n; ++j) {
                    violation -= unit[j] * y[j];
                }
                if (violation > amount) {
                    amount = violation;
                    worst = i;
                }
            }
            const auto found = rows.worst(y.data(), 1e-13);
            CHECK(found.row == worst);
            CHECK(found.amount == amount);
        }
    }
}

TEST_CASE("Among equally violated rows the scan returns the one with the smallest index") {
    ConstraintRows rows(2, 40);
    const std::array<double, 2> row{0.0, 3.0};
    for (int i = 0; i < 37; ++i) {
        rows.add(row, i == 11 || i == 20 || i == 36 ? 6.0 : 3.0);
    }
    rows.prepare(identityFactor());
    const ScaledVector y{};
    CHECK(rows.worst(y.data(), 0.0).row == 11);
    CHECK(rows.worst(y.data(), 0.0).amount == 2.0);
    CHECK(rows.worst(y.data(), 2.0).row == 37);
}

TEST_CASE("Without rows, or with none violated, the solution is exactly the target") {
    auto solver = identitySolver(6, 10);
    const std::array<double, 6> target{0.1, -0.2, 0.3, 1e-17, 5.0, -6.0};
    std::array<double, 6> x{};
    CHECK(solver.solve(target, x) == SolveStatus::Optimal);
    CHECK(x == target);
    CHECK(solver.activeRows() == 0);
    solver.addRow(std::array<double, 6>{1, 0, 0, 0, 0, 0}, 0.1); // touched, not violated
    CHECK(solver.solve(target, x) == SolveStatus::Optimal);
    CHECK(x == target);
    CHECK(solver.multipliers()[0] == 0.0);
}

TEST_CASE("One violated row moves the target along the metric's inverse by the closed formula") {
    ConstraintSolver solver(6, 1);
    solver.setMetric(toolMetric(6, 0.02));
    const std::array<double, 6> row{0, 0, 1, 0.03, 0, 0};
    solver.addRow(row, 0.001);
    CHECK_FALSE(solver.addRow(row, 5.0)); // full
    CHECK(solver.rows() == 1);
    const std::array<double, 6> target{0.002, 0, -0.004, 0.01, 0, 0};
    std::array<double, 6> x{};
    REQUIRE(solver.solve(target, x) == SolveStatus::Optimal);
    const double lambda = (0.001 - (-0.004 + 0.03 * 0.01)) / (1.0 + 0.03 * 0.03 / (0.02 * 0.02));
    CHECK(solver.multipliers()[0] == doctest::Approx(lambda).epsilon(1e-14));
    CHECK(x[0] == 0.002);
    CHECK(x[2] == doctest::Approx(-0.004 + lambda).epsilon(1e-14));
    CHECK(x[3] == doctest::Approx(0.01 + lambda * 0.03 / 0.0004).epsilon(1e-14));
    CHECK(solver.activeRows() == 1);
}

TEST_CASE("A row of zero length is infeasible when its offset is positive and inactive otherwise") {
    for (const double offset : {-1.0, 0.0, 1e-9}) {
        auto solver = identitySolver(3, 4);
        solver.addRow(std::array<double, 3>{0, 0, 0}, offset);
        solver.addRow(std::array<double, 3>{1, 0, 0}, 2.0);
        std::array<double, 3> x{};
        const auto status = solver.solve(std::array<double, 3>{0, 0, 0}, x);
        CHECK((status == SolveStatus::Optimal) == (offset <= 0.0));
        if (status == SolveStatus::Optimal) {
            CHECK(x[0] == 2.0);
        }
    }
}

TEST_CASE("A number that is not finite is never returned as a solution") {
    const std::array<double, 3> good{1, 0, 0}, start{0, 0, 0};
    std::array<double, 3> x{};
    for (const double bad : {kNaN, kInf, -kInf}) {
        auto solver = identitySolver(3, 4);
        solver.addRow(good, 1.0);
        CHECK(solver.solve(std::array<double, 3>{bad, 0, 0}, x) != SolveStatus::Optimal);
        solver.addRow(std::array<double, 3>{0, bad, 0}, -1.0);
        CHECK(solver.solve(start, x) != SolveStatus::Optimal);
    }
    auto solver = identitySolver(3, 4);
    solver.addRow(good, kNaN);
    CHECK(solver.solve(start, x) == SolveStatus::Infeasible);
    solver.setOffset(0, kInf);
    CHECK(solver.solve(start, x) == SolveStatus::Infeasible);
    solver.setOffset(0, -kInf);
    CHECK(solver.solve(start, x) == SolveStatus::Optimal);
    solver.setOffset(0, 0.25);
    CHECK(solver.solve(start, x) == SolveStatus::Optimal);
    CHECK(x[0] == 0.25);
}

TEST_CASE("Changing an offset or the metric gives the solution of a newly built solver") {
    Rng random(11);
    for (int i = 0; i < 200; ++i) {
        auto set = makeSet(RowFamily::Feasible, 6, 1 + random.below(40), 0.05, random);
        ConstraintSolver changed(6, 64), fresh(6, 64);
        load(changed, set);
        std::array<double, 6> x{}, y{};
        changed.solve(set.target, x);
        set.metric = toolMetric(6, 0.5);
        const size_t row = random.below(set.rows());
        set.offsets[row] -= 1e-3;
        changed.setMetric(set.metric);
        changed.setOffset(row, set.offsets[row]);
        CHECK(changed.offset(row) == set.offsets[row]);
        load(fresh, set);
        REQUIRE(changed.solve(set.target, x) == SolveStatus::Optimal);
        REQUIRE(fresh.solve(set.target, y) == SolveStatus::Optimal);
        for (size_t j = 0; j < 6; ++j) {
            CHECK(x[j] == doctest::Approx(y[j]).epsilon(1e-12));
        }
    }
}

TEST_CASE(
    "A metric that is not symmetric, positive definite and finite is rejected, and so are 0 or 9 unknowns") {
    ConstraintSolver solver(2, 4);
    CHECK_THROWS_AS(solver.setMetric(std::array<double, 4>{1, 0.5, 0.4, 1}), Error);
    CHECK_THROWS_AS(solver.setMetric(std::array<double, 4>{1, 1, 1, 1}), Error);
    CHECK_THROWS_AS(solver.setMetric(std::array<double, 4>{1, 0, 0, -1}), Error);
    CHECK_THROWS_AS(solver.setMetric(std::array<double, 4>{1, 0, 0, kNaN}), Error);
    CHECK_THROWS_AS(solver.setMetric(std::array<double, 4>{kInf, 0, 0, 1}), Error);
    CHECK_THROWS_AS(solver.setMetric(std::array<double, 3>{1, 0, 0}), Error);
    CHECK_NOTHROW(solver.setMetric(std::array<double, 4>{1, 0.5, 0.5, 1}));
    CHECK_THROWS_AS(ConstraintSolver(0, 4), Error);
    CHECK_THROWS_AS(ConstraintSolver(kMaxUnknowns + 1, 4), Error);
}

TEST_CASE("Loading and solving do not allocate") {
    Rng random(5);
    std::vector<RowSet> sets;
    for (int i = 0; i < 50; ++i) {
        sets.push_back(makeSet(static_cast<RowFamily>(i % kRowFamilies), 6, 200, 0.03, random));
    }
    ConstraintSolver solver(6, 200);
    std::array<double, 6> x{};
    const uint64_t before = allocationCount();
    for (const auto& set : sets) {
        load(solver, set);
        solver.solve(set.target, x);
        solver.solve(set.target, x);
    }
    CHECK(allocationCount() == before);
    CHECK(before > 0); // the counter works
}
