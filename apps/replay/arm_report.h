// SPDX-License-Identifier: Apache-2.0
// Reports the arm of a run: arm.csv with one row per tick, and the section `arm` of summary.json.
#pragma once

#include "apps/output/csv.h"
#include "apps/replay/summary.h"
#include "engine/cycle/arm_setup.h"
#include "engine/run/channels.h"
#include "engine/types/output_file.h"

#include <filesystem>
#include <vector>

namespace fathom {

// One thread. Checks the limits again, independently of the engine, from the joints alone. Columns of
// arm.csv: t_s, one per joint [rad] or [m], grasp, residual_m, manipulability, at_limits, limit_violation,
// singular, grasp_held, flipped. With a real arm also real_arm (its state) and measured_<joint> per joint.
class ArmReport {
public:
    // realArm: description of the real arm that follows; empty = none.
    ArmReport(const std::filesystem::path& file, const ArmSetup& setup, const std::string& realArm = "");

    void add(const TickRow& row);
    OutputFile& file() { return file_; }
    // links: from ToolAudit::linkPenetration(); empty = not audited.
    ReplaySummary::Arm summary(const std::vector<double>& links);

private:
    // Largest excess over a position limit [rad], [m] or over the travel that the speed limit allows in the
    // tick; 0 = all limits obeyed.
    double violation(const TickRow& row) const;
    void addDriven(const TickRow& row);

    const ArmSetup& armSetup_;
    OutputFile file_;
    CsvRow row_;
    ReplaySummary::Arm sums_;
    std::vector<float> residuals_, tipLags_;
    std::array<uint64_t, kArmStates> ticks_{}; // ticks in each state of a real arm
};

} // namespace fathom
