// SPDX-License-Identifier: Apache-2.0
// Measures the CPU's time budgets that no other study measures at the specified size: nearest spheres, cull,
// grid, solver and tick.
#include "apps/profile/brute_force.h"
#include "apps/profile/budget_sets.h"
#include "apps/profile/drag.h"
#include "apps/profile/frame_sequence.h"
#include "apps/profile/studies.h"

#include "engine/contact/cull_cpu.h"
#include "engine/haptics/constraint_solver.h"
#include "engine/types/thread_pool.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr double kDepth = 0.002;       // [m] penetration of the tool
constexpr double kBudgetReach = 0.01;  // [m] reach of the cull
constexpr int k60 = 122, k300 = 274;   // half a wall's edge, in spheres; 60 025 and 301 401 spheres
constexpr size_t kSamplesForP99 = 100; // samples; fewer give no p99

struct Budget {
    double p50, p99; // [ms] wall time; NaN = no budget
};

// Number of measured poses, and how many of them are compared with brute force.
struct Amount {
    size_t poses, compared, samples;
};
Amount amountOf(const StudyContext& context) {
    return context.settings.quick ? Amount{16, 1, 128} : Amount{200, 8, 2000};
}

// Describes a percentile against its budget.
std::string figureOf(const char* rank, double measured, double budget) {
    return std::string(rank) + " " + digits(measured * 1e3, 4) + " us" +
           (std::isfinite(budget) ? " of " + digits(budget * 1e3, 4) : "");
}

// Whether the budget is met: 1, 0, or NaN without a budget.
double keptBy(const Spread& wall, const Budget& budget) {
    if (!std::isfinite(budget.p50)) {
        return NAN;
    }
    const bool late = std::isfinite(budget.p99) && wall.p99 > budget.p99;
    return wall.p50 <= budget.p50 && !late ? 1.0 : 0.0;
}

void addRow(Study& study, const std::string& what, const std::string& size, const Cost& cost,
            const Budget& budget, double shareInContact) {
    StudyRow row;
    row.source = what;
    row.setting = size;
    row.cost = cost;
    const double kept = keptBy(cost.submit, budget);
    row.more = {budget.p50, budget.p99, kept, shareInContact};
    study.findings.push_back(what + ", " + size + ": " + figureOf("p50", cost.submit.p50, budget.p50) + ", " +
                             figureOf("p99", cost.submit.p99, budget.p99) +
                             (std::isnan(kept) ? ", no budget"
                              : kept != 0.0    ? ": kept"
                                               : ": missed"));
    study.rows.push_back(std::move(row));
}

// Times work(i) cyclically for i = 0 .. of - 1, one sample per call.
template <class Work>
Cost sampleEach(size_t samples, size_t of, Work&& work) {
    CpuSamples taken;
    for (size_t i = 0; i < of; ++i) { // warm-up
        work(i);
    }
    for (size_t i = 0; i < std::max(samples, kSamplesForP99); ++i) {
        const Clocks clocks;
        work(i % of);
        taken.take(clocks);
    }
    return taken.cost();
}

// Fraction of poses in contact. Throws when the depth of a pose is wrong.
double touching(const TouchRig& rig, const std::string& setting) {
    size_t count = 0;
    for (const Pose& pose : rig.poses) {
        const double gap = rig.smallestGap(pose, 0.001);
        verify(std::abs(gap + kDepth) < 1e-6, "budgets", setting,
               "the tool is " + digits(-gap * 1e3) + " mm in the wall");
        count += gap < 0.0 ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(rig.poses.size());
}

std::string sizeOf(const TouchRig& rig) {
    return std::to_string(rig.wall.spheres.size()) + " spheres, " + std::to_string(rig.tool.leafCount()) +
           " leaves";
}

void addNearest(const StudyContext& context, Study& study, const TouchRig& rig, const Budget& budget) {
    const Amount amount = amountOf(context);
    PosedLeaves leaves;
    std::vector<NearestSphere> found;
    const auto ask = [&](size_t i) {
        poseLeaves(rig.tool, rig.poses[i], rig.wall.origin, leaves);
        nearestSpheres(leaves, 0.0f, rig.grid, found);
    };
    for (size_t i = 0; i < amount.compared; ++i) {
        ask(i);
        const std::string wrong = nearestDiffers(rig, rig.poses[i], 0.0, found);
        verify(wrong.empty(), "budgets", "nearest, " + sizeOf(rig), wrong);
    }
    const double share = touching(rig, "nearest, " + sizeOf(rig));
    addRow(study, "nearest touching sphere of each leaf", sizeOf(rig),
           sampleEach(amount.samples, rig.poses.size(), ask), budget, share);
}

void addCull(const StudyContext& context, Study& study, const TouchRig& rig) {
    const Amount amount = amountOf(context);
    PosedLeaves leaves;
    CullCpu cull;
    std::vector<uint32_t> found, all;
    std::vector<uint8_t> marks;
    const auto ask = [&](size_t i) {
        poseLeaves(rig.tool, rig.poses[i], rig.wall.origin, leaves);
        cull.cull(leaves, static_cast<float>(kBudgetReach), rig.grid, found);
    };
    for (size_t i = 0; i < rig.poses.size(); ++i) {
        ask(i);
        std::sort(found.begin(), found.end());
        bruteForceCull(leaves, static_cast<float>(kBudgetReach), rig.wall.spheres, marks, all);
        verify(found == all, "budgets", "cull, " + sizeOf(rig), "it differs from brute force");
    }
    const double share = touching(rig, "cull, " + sizeOf(rig));
    addRow(study, "cull at 10 mm reach by the grid", sizeOf(rig),
           sampleEach(amount.samples, rig.poses.size(), ask), {0.1, NAN}, share);
    ContactSet set;
    addRow(study, "whole contact set at 10 mm reach", sizeOf(rig),
           sampleEach(
               amount.samples, rig.poses.size(),
               [&](size_t i) { cull.query(rig.tool, rig.poses[i], kBudgetReach, rig.wall, rig.grid, set); }),
           {NAN, NAN}, share);
}

// Checks that the grid has every sphere once, in the same order for every number of builders.
void verifyGrid(const TouchRig& rig, const RegionGrid& grid, const std::string& who) {
    std::vector<uint32_t> order(grid.order().begin(), grid.order().end());
    verify(std::equal(order.begin(), order.end(), rig.grid.order().begin(), rig.grid.order().end()),
           "budgets", "grid, " + who, "its order differs from that of a grid built by one thread");
    for (size_t slot = 0; slot < order.size(); ++slot) {
        verify(grid.x()[slot] == rig.wall.spheres.x[order[slot]] &&
                   grid.radius()[slot] == rig.wall.spheres.radius[order[slot]],
               "budgets", "grid, " + who, "a slot holds the wrong sphere");
    }
    std::sort(order.begin(), order.end());
    for (size_t i = 0; i < order.size(); ++i) {
        verify(order[i] == i, "budgets", "grid, " + who, "a sphere is missing");
    }
    verify(order.size() == rig.wall.spheres.size(), "budgets", "grid, " + who, "a sphere is missing");
}

void addGrid(const StudyContext& context, Study& study, const TouchRig& rig, double budget) {
    const uint32_t publishers =
        makePlan(everyPointScene(), wallFrame(640, 480, 1.0).camera, 1, context.device.facts()).publishers;
    for (const uint32_t members : {publishers, 1u}) {
        ThreadPool workers(members);
        RegionGrid grid;
        const std::string who =
            members == 1 ? "one thread" : std::to_string(members) + " threads, as publishing has here";
        grid.build(rig.wall.spheres, &workers);
        verifyGrid(rig, grid, who);
        addRow(study, "grid over the whole set", std::to_string(rig.wall.spheres.size()) + " spheres, " + who,
               sampleEach(amountOf(context).samples / 10, 1,
                          [&](size_t) { grid.build(rig.wall.spheres, &workers); }),
               {budget, NAN}, NAN);
        if (publishers == 1) {
            return;
        }
    }
}

void addSolver(const StudyContext& context, Study& study, const TouchRig& rig) {
    const std::vector<ContactProblem> problems = contactProblems(rig);
    const std::string size = "64 rows in each of " + std::to_string(problems.size()) + " poses";
    verify(problems.size() >= 8, "budgets", "solver, " + size, "too few poses have enough contacts");
    ConstraintSolver solver(6, ContactProblem::kRows);
    std::array<double, 6> x{};
    SolveStatus status = SolveStatus::Optimal;
    const auto solve = [&](size_t i) {
        const ContactProblem& p = problems[i];
        solver.clearRows();
        for (size_t row = 0; row < ContactProblem::kRows; ++row) {
            solver.addRow({p.normals.data() + 6 * row, 6}, p.offsets[row]);
            solver.setKey(row, p.keys[row]);
        }
        status = solver.solve(p.target, x);
    };
    solver.setMetric(problems.front().metric);
    size_t pushed = 0;
    for (size_t i = 0; i < problems.size(); ++i) {
        solve(i);
        verify(status == SolveStatus::Optimal, "budgets", "solver, " + size, "no optimum was found");
        const double worst = checkKkt(problems[i].view(), x, solver.multipliers()).worst();
        verify(worst <= 1e-9, "budgets", "solver, " + size,
               "the optimality conditions are violated by " + digits(worst));
        pushed += solver.activeRows() > 0 ? 1 : 0;
    }
    const double share = static_cast<double>(pushed) / static_cast<double>(problems.size());
    addRow(study, "solver with real contacts, rows added and solved", size,
           sampleEach(amountOf(context).samples, problems.size(), solve), {0.0015, 0.003}, share);
}

void addStep(const StudyContext& context, Study& study) {
    DragSetting d;
    d.ticks = static_cast<uint32_t>(amountOf(context).samples);
    d.spacing = 0.2 / 122.5;    // 60 025 spheres
    d.proxy.rows.smooth = true; // as in scenes
    d.press = kDepth;
    d.follow = true;
    const DragResult run = drag(d);
    const std::string size =
        std::to_string(run.spheres) + " spheres, " + std::to_string(d.leaves) + " leaves";
    const double share = static_cast<double>(run.contacts) / d.ticks;
    verify(run.deepest <= 1e-9, "budgets", "step, " + size,
           "a leaf entered region spheres by " + digits(run.deepest * 1e6) + " um");
    verify(share >= 0.95, "budgets", "step, " + size,
           "the tool touches the wall in " + digits(share * 100.0) + " % of the ticks only");
    addRow(study, "haptic step pressed 2 mm, up to 4 solves with the full check", size, run.steps.cost(),
           {0.03, 0.08}, share);
}

// Label of a bar: the first word of the work, and its sizes.
std::string shortName(const StudyRow& row) {
    std::string size = row.setting.substr(0, row.setting.find(" in each"));
    size = size.substr(0, size.find(", as "));
    if (const size_t word = size.find(" spheres"); word != std::string::npos) {
        size.erase(word, 8);
    }
    return row.source.substr(0, row.source.find(' ')) + ", " + size;
}

PlotPanel budgetPanel(const Study& study) {
    PlotPanel panel{
        "p50 and p99 over their budgets", "measured / budget (1 = just met)", "", false, false, true, {}};
    PlotSeries middle{"p50", {}, false}, late{"p99", {}, false};
    for (const StudyRow& row : study.rows) {
        for (const auto& [series, rank, measured, budget] :
             {std::tuple{&middle, "p50, ", row.cost.submit.p50, row.more[0]},
              std::tuple{&late, "p99, ", row.cost.submit.p99, row.more[1]}}) {
            if (std::isfinite(budget)) {
                series->points.push_back({measured / budget, 0.0, rank + shortName(row), false, false});
            }
        }
    }
    panel.series = {middle, late};
    return panel;
}

} // namespace

Study budgetsStudy(const StudyContext& context) {
    Study study;
    study.name = "budgets";
    study.title = "Budgets: the CPU's work against its budgets";
    study.verified = "nearest spheres against brute force in float64; culls equal to brute force; grids hold "
                     "each sphere once, in the same order; solutions satisfy the optimality conditions to "
                     "1e-9; no leaf enters a sphere; tools are at the stated depth in the wall";
    study.noDefault = "its rows are different work, each with its own budget";
    study.timeName = "wall time p50";
    study.moreNames = {"budget_p50_ms", "budget_p99_ms", "kept", "share_in_contact"};
    const size_t poses = amountOf(context).poses;
    const TouchRig ordinary(k60, 256, poses, kDepth), large(k300, 1024, poses, kDepth);
    addNearest(context, study, ordinary, {0.008, NAN});
    addNearest(context, study, large, {0.02, NAN});
    addCull(context, study, ordinary);
    addGrid(context, study, ordinary, 1.0);
    addGrid(context, study, large, 5.0);
    addSolver(context, study, TouchRig(k60, 2048, std::max<size_t>(poses, 100), 0.0));
    addStep(context, study);
    study.panels = {budgetPanel(study)};
    return study;
}

} // namespace fathom::profile
