// SPDX-License-Identifier: Apache-2.0
// The three parts of the study `peers`: the same work done by Fathom and by other libraries, on equal inputs.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

// Columns of StudyRow::more in this study.
enum PeerColumn : size_t {
    kRatio,       // time over Fathom's
    kRatioSubmit, // time over Fathom's GPU method, submission to result
    kBuild,       // [ms] p50 build time of the search structure
    kBuildRatio,  // build time over Fathom's
    kThreads,     // threads that share the work; NaN for a GPU
    kFound,       // spheres within reach, mean over the poses
    kTies,        // answers that differ, but within 1 um of the limit
    kFromOurs,    // [mm] RMS of depth against Fathom's result, away from edges
    kFromTruth,   // [mm] RMS of depth against the exact surface, away from edges
    kPeerColumns
};
inline StudyRow peerRow(std::string source, std::string setting) {
    StudyRow row;
    row.source = std::move(source);
    row.setting = std::move(setting);
    row.more.assign(kPeerColumns, std::numeric_limits<double>::quiet_NaN());
    return row;
}
// Fills in the ratios of all rows from `first` on to row `ours`, and to row `gpu`'s time from submission to
// result.
void fillRatios(std::vector<StudyRow>& rows, size_t first, size_t ours, size_t gpu);
// The time that the study compares [ms]: device time for a pass of Fathom, CPU time of the calling thread for
// a contact query, otherwise wall time.
double peerTime(const StudyRow& row);
// Threads of a CPU device; NaN for a GPU.
double deviceThreads(const gpu::Device& device);

// Each appends its rows; Fathom's come first in each source. Throws Error when Fathom's answer is wrong.
void addPeerFilters(const StudyContext& context, std::vector<StudyRow>& rows);
void addPeerPoints(const StudyContext& context, std::vector<StudyRow>& rows);
void addPeerCollision(const StudyContext& context, std::vector<StudyRow>& rows);

// Start of source names such as "contact 10.24 k spheres x 64 leaves"; the plots select rows by it.
inline constexpr const char* kContactPrefix = "contact ";

} // namespace fathom::profile
