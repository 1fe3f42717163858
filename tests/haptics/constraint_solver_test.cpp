// SPDX-License-Identifier: Apache-2.0
// The solver against the KKT conditions and against least-distance programming, on random sets of every kind.
#include "tests/haptics/constraint_sets.h"
#include "tests/support/sanitized.h"

#include "engine/reference/nearest_point.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <string>

using namespace fathom;

namespace {

constexpr std::array<size_t, 12> kRowCounts{1, 2, 3, 5, 7, 8, 9, 17, 33, 64, 129, 512};

struct Tally {
    int sets = 0, optimal = 0, infeasible = 0, disagree = 0, limit = 0;
    double stationarity = 0.0, primal = 0.0, dual = 0.0, complementarity = 0.0, distance = 0.0;
};

double metricNorm(const RowSet& set, const std::vector<double>& v) {
    double sum = 0.0;
    for (size_t i = 0; i < set.unknowns; ++i) {
        for (size_t j = 0; j < set.unknowns; ++j) {
            sum += v[i] * set.metric[i * set.unknowns + j] * v[j];
        }
    }
    return std::sqrt(std::max(0.0, sum));
}

void compare(ConstraintSolver& solver, const RowSet& set, Tally& tally) {
    std::vector<double> x(set.unknowns);
    const SolveStatus status = solver.solve(set.target, x);
    const NearestPoint truth = nearestPoint(set.problem());
    ++tally.sets;
    tally.limit += status == SolveStatus::IterationLimit ? 1 : 0;
    if ((status == SolveStatus::Optimal) != truth.feasible) {
        ++tally.disagree;
        return;
    }
    if (status != SolveStatus::Optimal) {
        ++tally.infeasible;
        return;
    }
    ++tally.optimal;
    const KktResidual kkt = checkKkt(set.problem(), x, solver.multipliers());
    tally.stationarity = std::max(tally.stationarity, kkt.stationarity);
    tally.primal = std::max(tally.primal, kkt.primal);
    tally.dual = std::max(tally.dual, kkt.dual);
    tally.complementarity = std::max(tally.complementarity, kkt.complementarity);
    std::vector<double> difference(set.unknowns);
    for (size_t i = 0; i < set.unknowns; ++i) {
        difference[i] = x[i] - truth.x[i];
    }
    const double scale = metricNorm(set, set.target) + metricNorm(set, truth.x);
    tally.distance = std::max(tally.distance, metricNorm(set, difference) / scale);
}

} // namespace

TEST_CASE(
    "Every solution on random sets satisfies the KKT conditions and agrees with least-distance programming") {
    Rng random(20240601);
    ConstraintSolver solver6(6, 512), solver3(3, 512), solver1(1, 512), solver8(8, 512);
    for (size_t kind = 0; kind < kRowFamilies; ++kind) {
        Tally tally;
        for (const size_t n : {1, 3, 6, 8}) {
            ConstraintSolver& solver = n == 1 ? solver1 : n == 3 ? solver3 : n == 6 ? solver6 : solver8;
            for (const size_t rows : kRowCounts) {
                const int repeats = (rows > 100 ? 16 : 120) / (kSanitized ? 4 : 1);
                for (int i = 0; i < repeats; ++i) {
                    const double k = std::pow(10.0, random.uniform(-3.0, 0.0)); // 1 mm .. 1 m
                    const auto set = makeSet(static_cast<RowFamily>(kind), n, rows, k, random);
                    load(solver, set);
                    compare(solver, set, tally);
                }
            }
        }
        MESSAGE(std::string(nameOf(static_cast<RowFamily>(kind)))
                << ": " << tally.sets << " sets, " << tally.optimal << " optimal, " << tally.infeasible
                << " infeasible; stationarity " << tally.stationarity << ", primal " << tally.primal
                << ", dual " << tally.dual << ", complementarity " << tally.complementarity << ", distance "
                << tally.distance);
        CHECK(tally.disagree == 0);
        CHECK(tally.limit == 0);
        CHECK(tally.optimal > 100);
        CHECK(tally.primal <= 1e-12);
        CHECK(tally.stationarity <= 1e-9);
        CHECK(tally.dual <= 1e-9);
        CHECK(tally.complementarity <= 1e-9);
        CHECK(tally.distance <= 1e-9);
    }
}

TEST_CASE("A warm start changes the solution only by rounding while rows are added, removed and reordered") {
    Rng random(99);
    double worst = 0.0;
    int compared = 0;
    for (int run = 0; run < 200; ++run) {
        const auto kind = static_cast<RowFamily>(random.below(kRowFamilies));
        auto set = makeSet(kind, 6, 40, 0.05, random);
        ConstraintSolver warm(6, 64), cold(6, 64);
        warm.setMetric(set.metric);
        cold.setMetric(set.metric);
        std::vector<size_t> order(set.rows());
        for (size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        for (int tick = 0; tick < 20; ++tick) {
            std::swap(order[random.below(order.size())], order[random.below(order.size())]);
            set.target[random.below(6)] += random.uniform(-1e-3, 1e-3);
            warm.clearRows();
            cold.clearRows();
            for (size_t place = 0; place < order.size() - random.below(10); ++place) {
                const size_t i = order[place];
                warm.addRow(set.normal(i), set.offsets[i]);
                warm.setKey(place, 7000 + i);
                cold.addRow(set.normal(i), set.offsets[i]);
                cold.setKey(place, (1000u + static_cast<uint64_t>(tick)) * 100000u + i);
            }
            std::vector<double> x(6), y(6);
            const auto status = warm.solve(set.target, x);
            REQUIRE(status == cold.solve(set.target, y));
            if (status == SolveStatus::Optimal) {
                std::vector<double> difference(6);
                for (size_t i = 0; i < 6; ++i) {
                    difference[i] = x[i] - y[i];
                }
                worst = std::max(worst, metricNorm(set, difference) / metricNorm(set, set.target));
                ++compared;
            }
        }
    }
    MESSAGE(compared << " pairs, largest difference " << worst << " of the target");
    CHECK(compared > 1000);
    CHECK(worst <= 1e-9);
}

TEST_CASE("Walls that just touch allow motion along them, and walls that overlap by a nanometre do not") {
    for (const double overlap : {-1e-9, 0.0, 1e-9}) {
        ConstraintSolver solver(6, 2);
        solver.setMetric(toolMetric(6, 0.03));
        solver.addRow(std::array<double, 6>{0.6, 0, 0.8, 0, 0, 0}, 0.001);
        solver.addRow(std::array<double, 6>{-0.6, 0, -0.8, 0, 0, 0}, -0.001 + overlap);
        std::array<double, 6> x{};
        const auto status = solver.solve(std::array<double, 6>{0.003, 0.002, -0.01, 0, 0.1, 0}, x);
        CHECK((status == SolveStatus::Optimal) == (overlap <= 0.0));
        if (status == SolveStatus::Optimal) {
            CHECK(x[1] == 0.002);
            CHECK(x[4] == 0.1);
            CHECK(0.6 * x[0] + 0.8 * x[2] == doctest::Approx(0.001).epsilon(1e-12));
        }
    }
}

TEST_CASE("The corner of two planes at an angle of only 1e-9 is found exactly") {
    Rng random(17);
    double primal = 0.0, stationarity = 0.0;
    int corners = 0;
    for (int i = 0; i < 3000; ++i) {
        RowSet set;
        set.metric = toolMetric(6, 1.0);
        const dvec3 out = random.direction();
        const dvec3 side = glm::normalize(glm::cross(out, random.direction()));
        const double sign = i % 2 == 0 ? 1.0 : -1.0; // tilted the same way, or facing each other
        const dvec3 leaning = glm::normalize(sign * out + 1e-9 * side);
        const dvec3 corner = 1e-3 * random.direction();
        set.addContact(out, dvec3(0), glm::dot(out, corner));
        set.addContact(leaning, dvec3(0), glm::dot(leaning, corner));
        const dvec3 wanted = corner - 2e-3 * out - random.uniform(0.0, 1e-3) * side;
        set.target = {wanted.x, wanted.y, wanted.z, 0, 0, 0};
        ConstraintSolver solver(6, 2);
        load(solver, set);
        std::vector<double> x(6);
        REQUIRE(solver.solve(set.target, x) == SolveStatus::Optimal);
        corners += solver.activeRows() == 2 ? 1 : 0;
        const auto kkt = checkKkt(set.problem(), x, solver.multipliers());
        primal = std::max(primal, kkt.primal);
        stationarity = std::max(stationarity, kkt.stationarity);
    }
    MESSAGE(corners << " corners; primal " << primal << ", stationarity " << stationarity);
    CHECK(corners > 1000);
    CHECK(primal <= 1e-12);
    CHECK(stationarity <= 1e-9);
}
