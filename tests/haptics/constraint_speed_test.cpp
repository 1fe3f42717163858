// SPDX-License-Identifier: Apache-2.0
// Timings of the solver, printed and never asserted. The solutions are checked first.
#include "tests/haptics/constraint_sets.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>

using namespace fathom;

namespace {

struct Timing {
    double p50 = 0.0, p99 = 0.0; // [us]
};

Timing percentiles(std::vector<double>& us) {
    std::sort(us.begin(), us.end());
    return {us[us.size() / 2], us[us.size() * 99 / 100]};
}

// Rows of a tool pressed on a relief of spheres: correlated normals, most rows slack, about three active.
RowSet reliefSet(size_t rows, Rng& random) {
    RowSet set;
    set.metric = toolMetric(6, 0.03);
    set.target = {random.uniform(-0.002, 0.002), random.uniform(-0.002, 0.002), -0.002, 0.01, 0.0, -0.01};
    for (size_t i = 0; i < rows; ++i) {
        const dvec3 out = glm::normalize(dvec3(0, 0, 1) + 0.3 * random.direction());
        set.addContact(out, 0.5 * random.inCube(0.1), -random.uniform(0.0, 0.002));
    }
    return set;
}

using Clock = std::chrono::steady_clock;
double microseconds(Clock::time_point from) {
    return std::chrono::duration<double, std::micro>(Clock::now() - from).count();
}

} // namespace

TEST_CASE("Timings of the solver on contact rows are printed") {
    Rng random(7);
    ConstraintSolver solver(6, 512);
    for (const size_t rows : {4, 16, 64, 256, 512}) {
        std::vector<double> whole, alone, warm;
        double active = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const auto set = reliefSet(rows, random);
            solver.setMetric(set.metric);
            std::array<double, 6> x{}, again{};
            const auto start = Clock::now();
            solver.clearRows();
            for (size_t row = 0; row < rows; ++row) {
                solver.addRow(set.normal(row), set.offsets[row]);
                solver.setKey(row, 1000000u * static_cast<uint64_t>(i) + row); // unknown keys: a cold start
            }
            const auto loaded = Clock::now();
            REQUIRE(solver.solve(set.target, x) == SolveStatus::Optimal);
            alone.push_back(microseconds(loaded));
            whole.push_back(microseconds(start));
            active += solver.activeRows();
            const auto second = Clock::now();
            REQUIRE(solver.solve(set.target, again) == SolveStatus::Optimal);
            warm.push_back(microseconds(second));
            for (size_t j = 0; j < 6; ++j) {
                CHECK(again[j] == doctest::Approx(x[j]).epsilon(1e-12));
            }
        }
        const Timing a = percentiles(alone), w = percentiles(whole), again = percentiles(warm);
        MESSAGE(rows << " rows, " << active / 2000.0 << " active: solve p50 " << a.p50 << " p99 " << a.p99
                     << " us; with adding the rows " << w.p50 << " / " << w.p99
                     << " us; the same rows again, warm " << again.p50 << " / " << again.p99 << " us");
    }
}
