// SPDX-License-Identifier: Apache-2.0
// The time budgets that the project aims at, and what a run made of them.
#pragma once

#include "apps/replay/summary.h"
#include "engine/types/camera_info.h"
#include "engine/types/device_facts.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

struct BudgetFigure {
    std::string what, unit;
    double measured = 0.0, budget = 0.0;
    bool holds() const { return measured <= budget; }
};

// Frame latency p50 (upload to published) where a budget exists for the frame's size and the device:
// 640x480 up to a tenth of the pixels forbidden, 640x480 and 1280x720 beyond that; CPU devices and discrete
// ones. The haptic tick's p50 and p99 always, with the tool's leaves and for how many the budget is. Figures
// that were not measured are left out.
std::vector<BudgetFigure> budgetFigures(const ReplaySummary& summary, const Intrinsics& depth,
                                        DeviceKind device, size_t leaves);

} // namespace fathom
