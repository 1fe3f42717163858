// SPDX-License-Identifier: Apache-2.0
// What a run leaves of its arm: arm.csv, one row per tick, and the section `arm` of summary.json.
#pragma once

#include "apps/replay/csv.h"
#include "apps/replay/output_file.h"
#include "apps/replay/summary.h"
#include "apps/replay/tick_record.h"
#include "engine/cycle/arm_rig.h"

#include <filesystem>
#include <vector>

namespace fathom {

// One thread. The limits are checked here once more, from the joints alone. arm.csv: t_s, a column per joint
// [rad], [m], grasp, residual_m, manipulability, at_limits, limit_violation, singular, grasp_held; where a
// real arm follows also real_arm (its state) and measured_ with every joint's name.
class ArmReport {
public:
    // realArm: what follows, in words; empty = nothing does.
    ArmReport(const std::filesystem::path& file, const ArmRig& rig, const std::string& realArm = "");

    void add(const TickRecord& tick);
    void commit() { file_.commit(); }
    // links: of ToolAudit::linkPenetration(); empty = not audited.
    ReplaySummary::Arm summary(const std::vector<double>& links);

private:
    // [rad], [m] by which joints or fingers lie beyond their limits or joints went faster than they can; 0 =
    // all obeyed.
    double violation(const TickRecord& tick) const;
    void addDriven(const TickRecord& tick);

    const ArmRig& rig_;
    OutputFile file_;
    CsvRow row_;
    ReplaySummary::Arm sums_;
    std::vector<float> residuals_, tipLags_;
    std::array<uint64_t, kArmStates> ticks_{}; // by state of a real arm
};

} // namespace fathom
