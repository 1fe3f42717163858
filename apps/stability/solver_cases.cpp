// SPDX-License-Identifier: Apache-2.0
// Group solver: random row sets of every family and scale against the exact optimum in higher precision.
#include "apps/stability/case_text.h"
#include "apps/stability/solver_trial.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kSolverLimit = 1e-9; // relative limit of the KKT residual, of violations (over the step) and
                                      // of the distance to the optimum

size_t sizeOf(RunLength runLength, size_t full) {
    return runLength == RunLength::Full ? full : std::max<size_t>(40, full / 25);
}

size_t someRows(Rng& rng) {
    return std::min<size_t>(SolverTrial::kMaxRows, static_cast<size_t>(rng.logUniform(1.0, 513.0)));
}

std::string counts(const SolverTally& t) {
    return num(t.sets) + " sets of 1 to 512 rows, " + num(t.optimal) + " optimal, " + num(t.infeasible) +
           " infeasible; KKT " + num(t.kkt) + ", violated row " + num(t.violation) +
           " of the step, distance to the exact optimum " + num(t.distance) + " of the target; at most " +
           num(100.0 * t.changes) + " % of the guard's changes" +
           (t.silent > 0 ? "; " + num(t.silent) + " without a second opinion." : ".");
}

Outcome judged(const SolverTally& tally, const std::string& what) {
    Outcome out =
        outcomeOf(tally.worst(), kSolverLimit, "1",
                  "Worst of KKT residual, violated row and distance to the optimum in long double. " + what +
                      counts(tally));
    require(out, tally.disagreements == 0,
            num(tally.disagreements) + " sets where the two methods disagree on feasibility");
    require(out, tally.cycled == 0, num(tally.cycled) + " sets ended by the cycling guard");
    require(out, tally.optimal * 20 >= tally.sets, "too few solvable sets to judge");
    Outcome::Curve curve{"worst residual", "rows", "relative residual", {}, {}, true, true};
    for (size_t k = 0; k < tally.byRows.size(); ++k) {
        if (tally.byRows[k] > 0.0) {
            curve.x.push_back(std::exp2(static_cast<double>(k)));
            curve.y.push_back(std::max(tally.byRows[k], 1e-18));
        }
    }
    out.curves.push_back(std::move(curve));
    return out;
}

Outcome familyCase(RunLength runLength, RowFamily family) {
    Rng rng(1000 + static_cast<uint64_t>(family));
    SolverTrial trial;
    SolverTally tally;
    const size_t sets = sizeOf(runLength, 7000);
    for (size_t i = 0; i < sets; ++i) {
        RowScale scale;
        scale.radius = rng.logUniform(0.001, 1.0);
        trial.judge(makeRowSet(family, someRows(rng), scale, rng), tally);
    }
    return judged(tally, "Gyration radius 1 mm to 1 m. ");
}

// All families at one scale of tool and metric.
Outcome scaleCase(RunLength runLength, const RowScale& scale, const std::string& what) {
    Rng rng(77);
    SolverTrial trial;
    SolverTally tally;
    const size_t sets = sizeOf(runLength, 7000);
    for (size_t i = 0; i < sets; ++i) {
        const auto family = static_cast<RowFamily>(i % kRowFamilies);
        trial.judge(makeRowSet(family, someRows(rng), scale, rng), tally);
    }
    return judged(tally, what);
}

Outcome armCase(RunLength runLength, size_t unknowns) {
    Rng rng(8);
    SolverTrial trial(static_cast<int>(unknowns));
    SolverTally tally;
    const size_t sets = sizeOf(runLength, 5000);
    for (size_t i = 0; i < sets; ++i) {
        trial.judge(makeArmSet(unknowns, someRows(rng), rng.logUniform(1e-6, 1e-2), rng), tally);
    }
    return judged(tally, std::to_string(unknowns) + " unknowns, full metric of condition up to about 1e7. ");
}

// Sets whose feasibility is known by construction, down to a margin of 1e-9 of the step.
Outcome feasibilityCase(RunLength runLength) {
    Rng rng(31);
    SolverTrial trial;
    SolverTally tally;
    uint64_t wrong = 0, infeasible = 0;
    const size_t sets = sizeOf(runLength, 10000);
    const RowScale scale;
    for (size_t i = 0; i < sets; ++i) {
        const bool feasible = i % 2 == 0;
        const double margin = scale.step * rng.logUniform(1e-9, 1e-1);
        const RowSet set = makeCertainSet(feasible, std::max<size_t>(2, someRows(rng)), margin, scale, rng);
        const bool found = trial.judge(set, tally) == SolveStatus::Optimal;
        wrong += found != feasible ? 1 : 0;
        infeasible += feasible ? 0 : 1;
    }
    return outcomeOf(static_cast<double>(wrong + tally.disagreements), 0.0, "sets",
                     "Wrong answers among " + num(tally.sets) + " sets, " + num(infeasible) +
                         " of them made infeasible by a positive combination of rows that contradicts itself "
                         "by 1e-9 to 1e-1 of the step; "
                         "least-distance programming in long double gives a second opinion (" +
                         num(tally.disagreements) + " disagreements).");
}

Outcome iterationCase(RunLength runLength) {
    Rng rng(55);
    SolverTrial trial;
    SolverTally tally;
    Outcome::Curve curve{"changes of the active set", "rows", "share of the guard", {}, {}, true, false};
    for (size_t rows = 1; rows <= SolverTrial::kMaxRows; rows *= 2) {
        SolverTally some;
        const size_t sets = sizeOf(runLength, 800);
        for (size_t i = 0; i < sets; ++i) {
            RowScale scale;
            scale.arm = rng.logUniform(0.001, 10.0);
            scale.radius = rng.logUniform(0.001, 1.0);
            trial.judge(makeRowSet(static_cast<RowFamily>(i % kRowFamilies), rows, scale, rng), some);
        }
        curve.x.push_back(static_cast<double>(rows));
        curve.y.push_back(some.changes);
        tally.add(some);
    }
    Outcome out = outcomeOf(
        tally.changes, 0.9, "1",
        "Largest number of rows added or dropped in one solve, as a share of the guard 16 n + 64 + rows/4: " +
            num(tally.sets) + " sets of every family, tools of 1 mm to 10 m; " + num(tally.cycled) +
            " ended by the guard.");
    require(out, tally.cycled == 0, "the guard ended a solve");
    out.curves.push_back(std::move(curve));
    return out;
}

// Ill-conditioned sets: rounding the rows alone moves the optimum, so the distance is measured in units of
// that shift.
Outcome conditioned(SolverTally tally, const std::string& what) {
    const double ofRounding = tally.ofRounding;
    const double distance = tally.distance;
    tally.distance = 0.0;
    tally.byRows = {};
    Outcome out = judged(
        tally, what +
                   "Figure: KKT residual and violated row only; the distance to the exact optimum, up to " +
                   num(distance) + ", is below 1e-9 or at most " + num(ofRounding) +
                   " times the distance by which one rounding of the rows moves that optimum, so no float64 "
                   "method is much nearer; required: 64 times. ");
    require(out, ofRounding <= 64.0, "an optimum missed by more than 64 times the effect of rounding");
    out.curves.clear();
    return out;
}

// Two planes at an angle of 1e-9, which intersect far away.
Outcome leaningCase(RunLength runLength) {
    Rng rng(17);
    SolverTrial trial;
    SolverTally tally;
    const size_t sets = sizeOf(runLength, 5000);
    for (size_t i = 0; i < sets; ++i) {
        RowSet set = makeRowSet(RowFamily::FlatWall, 0, RowScale{}, rng);
        const double lean = rng.logUniform(1e-9, 1e-3);
        const dvec3 out = rng.direction();
        const dvec3 side = glm::normalize(glm::cross(out, rng.direction()));
        const dvec3 leaning = glm::normalize((i % 2 == 0 ? 1.0 : -1.0) * out + lean * side);
        const dvec3 corner = 1e-3 * rng.direction();
        set.addContact(out, dvec3(0.0), glm::dot(out, corner));
        set.addContact(leaning, dvec3(0.0), glm::dot(leaning, corner));
        const dvec3 wanted = corner - 2e-3 * out - rng.uniform(0.0, 1e-3) * side;
        set.target = {wanted.x, wanted.y, wanted.z, 0.0, 0.0, 0.0};
        trial.judge(set, tally);
    }
    return conditioned(tally, "Corners of two planes that differ by 1e-9 to 1e-3 rad. ");
}

Outcome mismatchedCase(RunLength runLength) {
    Rng rng(78);
    SolverTrial trial;
    SolverTally tally;
    RowScale scale;
    scale.arm = 10.0;
    scale.step = 1.0;
    scale.radius = 0.001;
    const size_t sets = sizeOf(runLength, 7000);
    for (size_t i = 0; i < sets; ++i) {
        trial.judge(makeRowSet(static_cast<RowFamily>(i % kRowFamilies), someRows(rng), scale, rng), tally);
    }
    return conditioned(tally, "Tool of 10 m with a gyration radius of 1 mm, every family. ");
}

// The same rows solved warm (rows appear, disappear and change order) and cold.
Outcome warmCase(RunLength runLength) {
    Rng rng(99);
    double worst = 0.0;
    uint64_t compared = 0, differ = 0;
    const size_t runs = sizeOf(runLength, 2000);
    for (size_t run = 0; run < runs; ++run) {
        RowSet set =
            makeRowSet(static_cast<RowFamily>(run % kRowFamilies), 1 + rng.below(80), RowScale{}, rng);
        ConstraintSolver warm(6, 80), cold(6, 80);
        warm.setMetric(set.metric);
        cold.setMetric(set.metric);
        for (uint64_t tick = 0; tick < 10; ++tick) {
            set.target[rng.below(6)] += rng.uniform(-1e-3, 1e-3);
            const size_t first = rng.below(set.rows());
            warm.clearRows();
            cold.clearRows();
            for (size_t k = 0; k < set.rows(); ++k) {
                const size_t i = (first + k) % set.rows();
                warm.addRow(set.normal(i), set.offsets[i]);
                warm.setKey(k, 7000 + i);
                cold.addRow(set.normal(i), set.offsets[i]);
                cold.setKey(k, 100000 * (tick + 1) + i);
            }
            std::array<double, 6> x{}, y{}, difference{};
            const SolveStatus status = warm.solve(set.target, x);
            differ += status != cold.solve(set.target, y) ? 1 : 0;
            if (status == SolveStatus::Optimal) {
                std::transform(x.begin(), x.end(), y.begin(), difference.begin(),
                               [](double a, double b) { return a - b; });
                worst = std::max(worst, metricLength(set, difference) / metricLength(set, set.target));
                ++compared;
            }
        }
    }
    Outcome out = outcomeOf(worst, kSolverLimit, "1",
                            "Difference of warm and cold start over the target, " + num(compared) +
                                " pairs, rows in changing order.");
    require(out, differ == 0, num(differ) + " pairs of different status");
    require(out, compared > 0, "nothing compared");
    return out;
}

RowScale scaleOf(double arm, double radius) {
    RowScale scale;
    scale.arm = arm;
    scale.radius = radius;
    return scale;
}

} // namespace

std::vector<Case> solverCases() {
    std::vector<Case> cases;
    for (size_t f = 0; f < kRowFamilies; ++f) {
        const auto family = static_cast<RowFamily>(f);
        cases.push_back({std::string("solver-") + nameOf(family), Group::Solver,
                         [family](RunLength runLength) { return familyCase(runLength, family); }});
    }
    const auto scaled = [&](const char* name, const RowScale& scale, const std::string& what) {
        cases.push_back(
            {name, Group::Solver, [=](RunLength runLength) { return scaleCase(runLength, scale, what); }});
    };
    scaled("solver-tool-1mm", scaleOf(0.001, 0.05), "Tool of 1 mm, every family. ");
    scaled("solver-tool-10m", scaleOf(10.0, 0.05), "Tool of 10 m, every family. ");
    scaled("solver-metric-1mm", scaleOf(0.1, 0.001), "Gyration radius 1 mm, every family. ");
    scaled("solver-metric-1m", scaleOf(0.1, 1.0), "Gyration radius 1 m, every family. ");
    cases.push_back({"solver-tool-10m-metric-1mm", Group::Solver, mismatchedCase});
    cases.push_back({"solver-eight-unknowns", Group::Solver, [](RunLength l) { return armCase(l, 8); }});
    cases.push_back({"solver-twelve-unknowns", Group::Solver, [](RunLength l) { return armCase(l, 12); }});
    cases.push_back({"solver-infeasible-recognised", Group::Solver, feasibilityCase});
    cases.push_back({"solver-bounded-changes", Group::Solver, iterationCase});
    cases.push_back({"solver-leaning-planes", Group::Solver, leaningCase});
    cases.push_back({"solver-warm-start", Group::Solver, warmCase});
    return cases;
}

} // namespace fathom::stability
