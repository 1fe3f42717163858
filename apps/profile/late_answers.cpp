// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/late_answers.h"

#include "apps/profile/drag.h"
#include "apps/profile/query_rows.h"

namespace fathom::profile {

namespace {

StudyRow lateRow(uint32_t delay, double reach, uint32_t ticks) {
    DragSetting setting;
    setting.reach = reach;
    setting.delay = delay;
    setting.ticks = ticks;
    const DragResult run = drag(setting);
    StudyRow row =
        queryRow("answers " + std::to_string(delay) + " ticks late", "reach " + digits(reach * 1e3) + " mm");
    row.isDefault = reach == 0.01;
    verify(run.deepest <= 1e-9, "query", row.setting,
           "a leaf entered region spheres by " + digits(run.deepest * 1e6) + " um");
    row.error = run.lagRms * 1e3;
    row.cost = run.queries.cost();
    row.more[kToolLeaves] = setting.leaves;
    row.more[kRegionSpheres] = static_cast<double>(run.spheres);
    row.more[kStalledTicks] = static_cast<double>(run.stalled);
    row.more[kReachMm] = reach * 1e3;
    return row;
}

} // namespace

PlotPanel stallPanel(const std::vector<StudyRow>& rows, uint32_t ticks) {
    PlotPanel panel;
    panel.title = "the same drag: reach against stalled ticks";
    panel.xLabel = "reach [mm]";
    panel.yLabel = "stalled ticks [% of " + std::to_string(ticks) + "]";
    panel.logY = false;
    std::vector<PlotSeries> byDelay;
    for (const StudyRow& row : rows) {
        if (byDelay.empty() || byDelay.back().name != row.source) {
            byDelay.push_back({row.source, {}, true});
        }
        const double share = 100.0 * row.more[kStalledTicks] / ticks;
        byDelay.back().points.push_back(
            {row.more[kReachMm], share, row.isDefault ? row.setting : "", row.isDefault, false});
    }
    panel.series.assign(byDelay.rbegin(), byDelay.rend());
    return panel;
}

void addLateAnswers(const StudyContext& context, Study& study) {
    Study late; // separate, so that fronts use only these rows
    late.name = study.name;
    late.errorName = study.errorName;
    late.errorUnit = study.errorUnit;
    late.timeName = study.timeName;
    late.rankBy.reason =
        "a shorter reach is enough when answers are in time; 10 mm is enough when they come 10 ticks late";
    const bool quick = context.settings.quick;
    const uint32_t ticks = quick ? 300 : 1500;
    for (uint32_t delay : quick ? std::vector<uint32_t>{0, 10} : std::vector<uint32_t>{0, 5, 10, 20}) {
        for (double reach :
             quick ? std::vector{0.002, 0.01} : std::vector{0.001, 0.002, 0.005, 0.01, 0.02, 0.03}) {
            late.rows.push_back(lateRow(delay, reach, ticks));
        }
    }
    markFront(late);
    PlotPanel lag = frontPanel(late, "free drag at 0.5 m/s past a wall: reach against lag");
    lag.logY = false;
    study.panels.push_back(std::move(lag));
    study.panels.push_back(stallPanel(late.rows, ticks));
    study.verdicts.insert(study.verdicts.end(), late.verdicts.begin(), late.verdicts.end());
    study.findings.insert(study.findings.end(), late.findings.begin(), late.findings.end());
    study.rows.insert(study.rows.end(), late.rows.begin(), late.rows.end());
}

} // namespace fathom::profile
