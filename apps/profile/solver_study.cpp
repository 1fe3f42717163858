// SPDX-License-Identifier: Apache-2.0
// Pose error against the converged optimum, and lag, over the time of a tick. Varies solves per tick, step
// cap, row selection and deadline.
#include "apps/profile/drag.h"
#include "apps/profile/interleave.h"
#include "apps/profile/studies.h"
#include "engine/types/angle.h"

namespace fathom::profile {

namespace {

constexpr double kMetric = 0.05;      // [m] that one radian counts as
constexpr double kConverged = 1e-7;   // [m] largest change when the number of solves doubles
constexpr double kSameOptimum = 1e-5; // [m] rounding error accumulated over ticks

const char* const kReduced = "reduced rows, "; // source of those rows

struct SolverSetting {
    uint32_t solves;
    double cap;            // [m]
    double deadline = 0.0; // [us], 0 = none
    RowReduction rows = {};
};

// Describes the row selection of a solve.
std::string rowsOf(const RowReduction& rows) {
    const RowReduction usual;
    std::string text = rows.reach != usual.reach ? "to " + digits(rows.reach) + " caps" : "";
    text += rows.cone != usual.cone ? "cone " + digits(rows.cone * 180.0 / M_PI) + " deg" : "";
    if (rows.first != usual.first) {
        text += std::to_string(rows.first) + (rows.checked ? " first" : " only");
    }
    return text.empty() ? "all rows" : text;
}

std::string nameOf(const SolverSetting& s) {
    return std::to_string(s.solves) + " solves, cap " + digits(s.cap * 1e3) + " mm" +
           (s.deadline > 0.0 ? ", " + digits(s.deadline) + " us" : "");
}

DragSetting dragOf(const StudyContext& context, double speed, const SolverSetting& s) {
    DragSetting d;
    d.speed = speed;
    d.ticks = context.settings.quick ? 200 : 1500;
    d.leaves = context.settings.quick ? 64 : 256;
    d.spacing = context.settings.quick ? 0.004 : 0.00175;
    d.proxy.solves = s.solves;
    d.proxy.stepCap = s.cap;
    d.proxy.rows = s.rows;
    d.deadlineMicros = s.deadline;
    d.follow = true;
    return d;
}

double apart(const Pose& a, const Pose& b) {
    const dquat turn = b.rotation * glm::conjugate(a.rotation);
    const double angle = 2.0 * std::atan2(glm::length(dvec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
    return std::hypot(glm::length(a.position - b.position), kMetric * angle);
}

struct Apart {
    double rms = 0.0, max = 0.0; // [m]
};
Apart apartAll(const DragResult& a, const DragResult& b) {
    Apart result;
    for (size_t i = 0; i < a.poses.size(); ++i) {
        const double d = apart(a.poses[i], b.poses[i]);
        result.rms += d * d / static_cast<double>(a.poses.size());
        result.max = std::max(result.max, d);
    }
    result.rms = std::sqrt(result.rms);
    return result;
}

// Ways to reduce the default's rows: cull by reach, merge nearly parallel rows, solve the most binding rows
// first and then check the rest, or use only the most binding rows.
std::vector<RowReduction> reductionsOf(bool quick) {
    if (quick) {
        return {{},
                {1.0},
                {2.0, 60.0 * kDegree},
                {2.0, NarrowPhase::kCone, 1, true},
                {2.0, NarrowPhase::kCone, 1, false}};
    }
    std::vector<RowReduction> list{{}, {1.0}, {4.0}, {2.0, 0.0}, {2.0, 60.0 * kDegree}};
    for (uint32_t first : {2u, 4u, 8u, 16u}) {
        list.push_back({2.0, NarrowPhase::kCone, first, true});
    }
    for (uint32_t first : {2u, 4u, 8u}) {
        list.push_back({2.0, NarrowPhase::kCone, first, false});
    }
    return list;
}

std::vector<SolverSetting> settingsOf(bool quick) {
    std::vector<SolverSetting> list;
    for (uint32_t solves : quick ? std::vector<uint32_t>{1, 4} : std::vector<uint32_t>{1, 2, 4, 8, 16}) {
        for (double cap : quick ? std::vector{0.002} : std::vector{0.0005, 0.001, 0.002, 0.004}) {
            list.push_back({solves, cap});
        }
    }
    for (double micros : quick ? std::vector{50.0} : std::vector{10.0, 20.0, 50.0, 100.0}) {
        list.push_back({4, 0.002, micros});
    }
    return list;
}

// Solving on few rows and checking the rest must give the same pose as solving on all rows, at every tick.
void verifyReduction(const SolverSetting& s, const DragResult& run, const DragResult& usual) {
    if (s.rows.first == 0 || !s.rows.checked) {
        return;
    }
    const Apart change = apartAll(run, usual);
    verify(change.max <= kSameOptimum, "solver", rowsOf(s.rows),
           "not the optimum over all rows: the tool is off by " + digits(change.max * 1e6) + " um");
}

StudyRow rowOf(const std::string& source, const std::string& name, const SolverSetting& s,
               const DragResult& run, const DragResult& optimum) {
    StudyRow row;
    row.source = source;
    row.setting = name;
    row.isDefault = s.solves == 4 && s.cap == 0.002 && s.deadline == 0.0 && rowsOf(s.rows) == "all rows";
    verify(run.deepest <= 1e-9, "solver", row.setting,
           "a leaf entered region spheres by " + digits(run.deepest * 1e6) + " um");
    const Apart error = apartAll(run, optimum);
    const double ticks = static_cast<double>(run.poses.size());
    row.error = error.rms * 1e3;
    row.cost = run.steps.cost();
    row.more = {error.max * 1e3,
                run.lagRms * 1e3,
                static_cast<double>(run.solves) / ticks,
                static_cast<double>(run.rounds) / ticks,
                static_cast<double>(run.stalled),
                static_cast<double>(run.contacts) / ticks};
    return row;
}

// Runs all settings interleaved. Unless a deadline cuts ticks short, each repeat gives the same poses as the
// first.
std::vector<DragResult> dragInterleaved(const StudyContext& context, double speed,
                                        const std::vector<SolverSetting>& settings) {
    std::vector<DragResult> runs(settings.size());
    interleave({}, settings.size(), [&](size_t i, const Repeats&) {
        DragResult run = drag(dragOf(context, speed, settings[i]));
        if (runs[i].poses.empty()) {
            runs[i] = std::move(run);
            return;
        }
        verify(settings[i].deadline > 0.0 || apartAll(run, runs[i]).max == 0.0, "solver", nameOf(settings[i]),
               "a repeated run has another result");
        runs[i].addTimes(run);
    });
    return runs;
}

void addSpeed(const StudyContext& context, Study& study, double speed) {
    const DragResult optimum = drag(dragOf(context, speed, {64, 0.002}));
    const Apart change = apartAll(optimum, drag(dragOf(context, speed, {128, 0.002})));
    verify(change.max <= kConverged, "solver", "64 solves",
           "not converged: twice as many solves move the tool by " + digits(change.max * 1e6) + " um");
    std::vector<SolverSetting> settings = settingsOf(context.settings.quick);
    const size_t plain = settings.size(); // later settings have reduced rows
    for (const RowReduction& rows : reductionsOf(context.settings.quick)) {
        settings.push_back({4, 0.002, 0.0, rows});
    }
    const std::vector<DragResult> runs = dragInterleaved(context, speed, settings);
    const DragResult usual = drag(dragOf(context, speed, {4, 0.002}));
    const std::string hand = "hand at " + digits(speed) + " m/s";
    for (size_t i = 0; i < settings.size(); ++i) {
        const SolverSetting& s = settings[i];
        verifyReduction(s, runs[i], usual);
        study.rows.push_back(i < plain ? rowOf(hand, nameOf(s), s, runs[i], optimum)
                                       : rowOf(kReduced + hand, rowsOf(s.rows), s, runs[i], optimum));
    }
}

} // namespace

Study solverStudy(const StudyContext& context) {
    Study study;
    study.name = "solver";
    study.title = "Solver: pose error to the converged optimum against the time of a tick";
    study.verified =
        "64 solves per tick are converged (128 change less than 0.1 um); few rows with a check of the others "
        "give the same pose as all rows, in every tick; no leaf enters a sphere in any run";
    study.errorName = "pose error RMS to the converged optimum, a radian as 50 mm";
    study.errorUnit = "mm";
    study.rankBy.time = cpuTime;
    study.timeName = "step, CPU time p50";
    study.moreNames = {"error_max_mm",        "lag_rms_mm",    "solves_a_turn",
                       "strengthened_a_turn", "stalled_turns", "share_in_contact"};
    study.rankBy.reason =
        "a cap of 2 mm and 4 solves allow hands of 8 m/s; slower hands need less. Rows within 1 cap take "
        "less time and give the same poses along this wall, but other poses between walls (suite haptics). "
        "Other reductions change the time by less than repeats differ, so all rows within 2 caps stay";
    for (double speed : context.settings.quick ? std::vector{2.0} : std::vector{0.3, 2.0, 6.0}) {
        addSpeed(context, study, speed);
    }
    markFront(study);
    const auto timeIf = [&study](bool reduced) {
        return [&study, reduced](const StudyRow& row) {
            return row.source.starts_with(kReduced) == reduced ? study.rankBy.time(row) : NAN;
        };
    };
    study.panels.push_back(frontPanel(study, "pose error", timeIf(false)));
    study.panels.push_back(frontPanel(study, "lag along the wall", timeIf(false),
                                      [](const StudyRow& row) { return row.more[1]; }));
    study.panels.push_back(frontPanel(study, "4 solves, cap 2 mm: choice of rows per solve", timeIf(true)));
    for (PlotPanel& panel : study.panels) {
        panel.yLabel = "pose error RMS [mm], a radian as 50 mm";
    }
    study.panels[1].yLabel = "lag of the tool behind the hand RMS [mm]";
    return study;
}

} // namespace fathom::profile
