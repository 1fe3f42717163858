// SPDX-License-Identifier: Apache-2.0
// The rows of the query study: what they hold beside the clocks, and how one tool on one set is measured.
#pragma once

#include "apps/profile/study.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fathom::profile {

// What StudyRow::more holds in this study. A column that does not apply to a row is not a number.
inline constexpr size_t kGpuCullSubmit = 0; // [ms] the GPU's cull alone, submission to result, wall p50
inline constexpr size_t kToolLeaves = 1;
inline constexpr size_t kRegionSpheres = 2;
inline constexpr size_t kFoundSpheres = 3; // of the answer
inline constexpr size_t kStalledTicks = 4; // of the drag's
inline constexpr size_t kReachMm = 5;      // [mm] certified by the answer; of the drag: asked for
inline constexpr size_t kCpuCullWall = 6;  // [ms] the CPU's cull alone, by the grid, wall p50
inline constexpr size_t kCpuCullCpu = 7;   // [ms] the same, CPU time of the calling thread p50
inline constexpr size_t kQueryColumns = 8;
std::vector<std::string> queryColumnNames();
StudyRow queryRow(std::string source, std::string setting);

// The ways that a query is answered, by which the setting of a row begins.
inline constexpr const char* kCpuWay = "CPU";
inline constexpr const char* kGpuWay = "GPU";
inline constexpr const char* kBruteWay = "brute force";
inline bool isWay(const StudyRow& row, const char* way) {
    return row.setting.rfind(way, 0) == 0;
}
// p50 [ms] of the cull alone, submission to result, by whichever way the row is of.
double cullTime(const StudyRow& row);

// CPU, GPU and brute force rows of each tool on a wall of width x height spheres that it touches: the whole
// contact set (brute force: its cull, it makes no more) and the cull alone. Brute force is not timed where it
// would try more than 4e8 pairs. Throws Error where two ways answer differently.
std::vector<StudyRow> queryRows(const StudyContext& context, uint32_t width, uint32_t height,
                                const std::vector<uint32_t>& toolLeaves);

// Culls by the grid and by brute force of small tools in the 16, 64 and 256 spheres of a wall that are
// nearest to them: where brute force wins. Throws Error as above.
std::vector<StudyRow> fewSphereRows(const StudyContext& context);

} // namespace fathom::profile
