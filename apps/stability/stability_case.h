// SPDX-License-Identifier: Apache-2.0
// One case of the stability suite: what it measures, against which limit, and whether that holds.
#pragma once

#include "apps/replay/curve_plot.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fathom::gpu {
class Device;
}

namespace fathom::stability {

// The nine groups of stability.json, in their order there.
enum class Group : uint8_t {
    Solver,
    Geometry,
    Guarantee,
    NewData,
    Stiff,
    Rotation,
    Guidance,
    Precision,
    LongRun
};
inline constexpr const char* kGroupNames[] = {"solver",   "geometry", "guarantee", "new-data", "stiff",
                                              "rotation", "guidance", "precision", "long-run"};

// How much of a case runs: the whole of it (`fathom stability`), or a shortened form with the same limits
// (`./run test`).
enum class RunLength : uint8_t { Full, Short };
// How many of something.
inline int some(RunLength runLength, int full, int brief) {
    return runLength == RunLength::Full ? full : brief;
}

// What one case came to. holds: the figure obeys the limit in the way that `relation` says.
struct Outcome {
    double figure = 0.0;
    double limit = 0.0;
    std::string unit;            // "m", "N", "1", ...; "1" = a pure number
    std::string relation = "<="; // figure <= limit, or ">="
    std::string note; // one sentence: what was varied, how many runs, derivation of a restated limit
    // Curves for the plots, optional: one a line, x and y with their labels.
    using Curve = PlotCurve;
    std::vector<Curve> curves;

    bool holds() const {
        return relation == ">=" ? figure >= limit : figure <= limit; // a NaN never holds
    }
};

struct Case {
    std::string name; // lower-case words with hyphens, unique
    Group group;
    std::function<Outcome(RunLength)> run; // throws only for internal errors
};

// The Vulkan device that the shaders run on, made when the first case asks for it. Throws Error when there is
// none.
using DeviceSource = std::function<gpu::Device&()>;

// One function a group, in <group>_cases.cpp.
std::vector<Case> solverCases();
std::vector<Case> geometryCases();
std::vector<Case> guaranteeCases();
std::vector<Case> newDataCases();
std::vector<Case> stiffCases();
std::vector<Case> rotationCases();
std::vector<Case> guidanceCases();
std::vector<Case> precisionCases(const DeviceSource& device);
std::vector<Case> longRunCases();

} // namespace fathom::stability
