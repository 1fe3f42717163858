// SPDX-License-Identifier: Apache-2.0
// What `replay` prints on standard output when a run has ended.
#pragma once

#include "apps/replay/realtime_replay.h"
#include "apps/replay/summary.h"

#include <filesystem>
#include <string>

namespace fathom {

// Four digits, but never an exponent for a large number.
std::string decimal(double x);

// out: the folder of the results.
void printSummary(const ReplaySummary& s, const std::filesystem::path& out);
// Measured figures next to the budgets of the camera's resolution.
void printBudgets(const ReplaySummary& summary, const Session& session);
void printRealtime(const RealtimeFigures& f, const ThreadPlacement& placement, const ReplaySummary& s);
void printDrivenArm(const ReplaySummary::Arm::Driven& driven);
void printHand(const LiveHand& hand);

} // namespace fathom
