// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/late_answers.h"

#include "apps/profile/drag.h"
#include "apps/profile/query_rows.h"

namespace fathom::profile {

void addLateAnswers(const StudyContext& context, Study& study) {
    Study late; // fronts are of these rows alone
    late.name = study.name;
    late.errorName = study.errorName, late.errorUnit = study.errorUnit, late.timeName = study.timeName;
    late.judgement.reason =
        "with answers in time a shorter reach does as well; 10 mm is what still serves when "
        "they come 10 ticks late";
    const bool quick = context.settings.quick;
    for (uint32_t delay : quick ? std::vector<uint32_t>{0, 10} : std::vector<uint32_t>{0, 5, 10, 20}) {
        for (double reach :
             quick ? std::vector{0.002, 0.01} : std::vector{0.001, 0.002, 0.005, 0.01, 0.02, 0.03}) {
            DragSetting setting;
            setting.reach = reach;
            setting.delay = delay;
            setting.ticks = quick ? 300 : 1500;
            const DragResult run = drag(setting);
            StudyRow row = queryRow("answers " + std::to_string(delay) + " ticks late",
                                    "reach " + digits(reach * 1e3) + " mm");
            row.isDefault = reach == 0.01;
            verify(run.deepest <= 1e-9, "query", row.setting,
                   "a leaf entered a sphere by " + digits(run.deepest * 1e6) + " um");
            row.error = run.lagRms * 1e3;
            row.cost = run.queries.cost();
            row.more[kToolLeaves] = setting.leaves;
            row.more[kRegionSpheres] = static_cast<double>(run.spheres);
            row.more[kStalledTurns] = static_cast<double>(run.stalled);
            row.more[kReachMm] = reach * 1e3;
            late.rows.push_back(std::move(row));
        }
    }
    markFront(late);
    PlotPanel panel = frontPanel(late, "free drag at 0.5 m/s past a wall: reach against lag");
    panel.logY = false;
    study.panels.push_back(std::move(panel));
    study.verdicts.insert(study.verdicts.end(), late.verdicts.begin(), late.verdicts.end());
    study.findings.insert(study.findings.end(), late.findings.begin(), late.findings.end());
    study.rows.insert(study.rows.end(), late.rows.begin(), late.rows.end());
}

} // namespace fathom::profile
