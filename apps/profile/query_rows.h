// SPDX-License-Identifier: Apache-2.0
// The rows of the query study: their extra columns, and the measurement of one tool on one set.
#pragma once

#include "apps/profile/study.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fathom::profile {

// Columns of StudyRow::more in this study. NaN if a column does not apply to a row.
inline constexpr size_t kGpuCullSubmit = 0; // [ms] GPU cull alone, submission to result, wall p50
inline constexpr size_t kToolLeaves = 1;
inline constexpr size_t kRegionSpheres = 2;
inline constexpr size_t kFoundSpheres = 3; // in the answer
inline constexpr size_t kStalledTicks = 4; // during the drag
inline constexpr size_t kReachMm = 5;      // [mm] certified by the answer; requested in the drag
inline constexpr size_t kCpuCullWall = 6;  // [ms] CPU cull alone, by the grid, wall p50
inline constexpr size_t kCpuCullCpu = 7;   // [ms] the same, CPU time of the calling thread p50
inline constexpr size_t kQueryColumns = 8;
std::vector<std::string> queryColumnNames();
StudyRow queryRow(std::string source, std::string setting);

// Query methods. The setting of a row starts with one of these.
inline constexpr const char* kCpuMethod = "CPU";
inline constexpr const char* kGpuMethod = "GPU";
inline constexpr const char* kBruteMethod = "brute force";
inline bool isMethod(const StudyRow& row, const char* method) {
    return row.setting.starts_with(method);
}
// p50 [ms] of the cull alone, submission to result, by the row's method.
double cullTime(const StudyRow& row);

// CPU, GPU and brute-force rows of each tool in contact with a wall of width x height spheres: the full
// contact set and the cull alone (brute force has only a cull). Does not time brute force above 4e8 pairs.
// Throws Error when two methods disagree.
std::vector<StudyRow> queryRows(const StudyContext& context, uint32_t width, uint32_t height,
                                const std::vector<uint32_t>& toolLeaves);

// Culls by grid and by brute force for small tools and the 16, 64 and 256 nearest spheres of a wall, where
// brute force is faster. Throws Error as above.
std::vector<StudyRow> fewSphereRows(const StudyContext& context);

} // namespace fathom::profile
