// SPDX-License-Identifier: Apache-2.0
// Compares the measured times of a run with the project's time budgets.
#pragma once

#include "apps/replay/summary.h"
#include "engine/types/camera_info.h"
#include "engine/types/device_facts.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

// One budget and the measured value, in `unit`; `note` says what the budget assumes.
struct BudgetFigure {
    std::string what, unit, note;
    double measured = 0.0, budget = 0.0;
    bool holds() const { return measured <= budget; }
};

// One entry per budget whose figure was measured. Frame latency p50 (upload to publication) has a budget for
// 640x480 with up to a tenth of the pixels forbidden, for 640x480 and 1280x720 with more, and only on CPU
// devices and discrete GPUs. The haptic tick always has budgets for p50 and p99; their notes state the tool's
// number of leaves and the number that the budget assumes. The first frame has one on CPU devices.
std::vector<BudgetFigure> budgetFigures(const ReplaySummary& summary, const Intrinsics& depth,
                                        DeviceKind device, size_t leaves);

} // namespace fathom
