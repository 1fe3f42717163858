// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/budgets.h"

#include <optional>

namespace fathom {

namespace {

constexpr double kStepP50 = 30.0, kStepP99 = 80.0; // [us]
constexpr double kFirstFrame = 3.0;                // [s] of a CPU device, all pipelines compiled
const char* const kStepOf = "the budget is for 256 leaves in contact with 60 000 spheres";

// [ms] Budget of the frame latency, from upload to publication.
std::optional<double> frameBudget(const Intrinsics& depth, double forbiddenShare, DeviceKind device) {
    const bool cpu = device == DeviceKind::Cpu;
    if (!cpu && device != DeviceKind::Discrete) {
        return std::nullopt;
    }
    if (depth.width == 640 && depth.height == 480) {
        return forbiddenShare <= 0.1 ? (cpu ? 8.0 : 0.090) : (cpu ? 20.0 : 0.120);
    }
    if (depth.width == 1280 && depth.height == 720) {
        return cpu ? 60.0 : 0.220;
    }
    return std::nullopt;
}

} // namespace

std::vector<BudgetFigure> budgetFigures(const ReplaySummary& summary, const Intrinsics& depth,
                                        DeviceKind device, size_t leaves) {
    double forbidden = 0.0;
    for (const ReplaySummary::FixtureRow& row : summary.fixtures) {
        forbidden += row.role == "forbidden" ? row.pointsMean.value_or(0.0) : 0.0;
    }
    std::vector<BudgetFigure> figures;
    const auto add = [&](const char* what, const char* unit, const std::optional<double>& measured,
                         double budget, const std::string& note) {
        if (measured) {
            figures.push_back({what, unit, note, *measured, budget});
        }
    };
    if (const auto budget = frameBudget(depth, forbidden / depth.pixels(), device)) {
        add("frame p50", "ms", summary.frames.latencyMs.p50, *budget, "");
    }
    const std::string of = std::to_string(leaves) + (leaves == 1 ? " leaf; " : " leaves; ") + kStepOf;
    add("step p50", "us", summary.haptic.stepMicros.p50, kStepP50, of);
    add("step p99", "us", summary.haptic.stepMicros.p99, kStepP99, of);
    if (device == DeviceKind::Cpu) {
        add("first frame", "s", summary.frames.first, kFirstFrame, "1 s with cached pipelines");
    }
    return figures;
}

} // namespace fathom
