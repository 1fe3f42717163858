// SPDX-License-Identifier: Apache-2.0
// One case of the stability suite: its figure, the limit, and whether the figure meets the limit.
#pragma once

#include "apps/output/curve_plot.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fathom::gpu {
class Device;
}

namespace fathom::stability {

// The ten groups, in the order of stability.json.
enum class Group : uint8_t {
    Solver,
    Geometry,
    Guarantee,
    NewData,
    Stiff,
    Rotation,
    Guidance,
    Precision,
    LongRun,
    Feel
};
inline constexpr const char* kGroupNames[] = {"solver",   "geometry", "guarantee", "new-data", "stiff",
                                              "rotation", "guidance", "precision", "long-run", "feel"};

// Full is the whole case (`fathom stability`). Short has fewer trials with the same limits (`./run test`).
enum class RunLength : uint8_t { Full, Short };
// Selects a count by run length.
inline int some(RunLength runLength, int full, int brief) {
    return runLength == RunLength::Full ? full : brief;
}

// The result of a case. holds(): the figure meets the limit under `relation`.
struct Outcome {
    double figure = 0.0;
    double limit = 0.0;
    std::string unit;            // "m", "N", "1", ...; "1" = a pure number
    std::string relation = "<="; // figure <= limit, or ">="
    std::string note;            // one sentence: what varied, how many runs, where the limit comes from
    // Optional curves for the plots, each with x, y and labels.
    using Curve = PlotCurve;
    std::vector<Curve> curves;

    bool holds() const {
        return relation == ">=" ? figure >= limit : figure <= limit; // NaN never holds
    }
};

struct Case {
    std::string name; // lower-case words with hyphens, unique
    Group group;
    std::function<Outcome(RunLength)> run; // throws only for internal errors
};

// Returns the Vulkan device for the shaders and creates it on first use. Throws Error when there is none.
using DeviceSource = std::function<gpu::Device&()>;

// One function per group, in <group>_cases.cpp.
std::vector<Case> solverCases();
std::vector<Case> geometryCases();
std::vector<Case> guaranteeCases();
std::vector<Case> newDataCases();
std::vector<Case> stiffCases();
std::vector<Case> rotationCases();
std::vector<Case> guidanceCases();
std::vector<Case> precisionCases(const DeviceSource& device);
std::vector<Case> longRunCases();
std::vector<Case> feelCases();

} // namespace fathom::stability
