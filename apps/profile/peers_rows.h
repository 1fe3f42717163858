// SPDX-License-Identifier: Apache-2.0
// The three parts of the study `peers`: the same work done by us and by libraries of others, on equal inputs.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

// What StudyRow::more holds in this study.
enum PeerColumn : size_t {
    kRatio,       // time over that of ours
    kRatioSubmit, // time over that of our GPU way, submit to result
    kBuild,       // [ms] of the structure that queries need, p50
    kBuildRatio,  // over that of ours
    kThreads,     // that the work is spread over; not a number: a GPU
    kFound,       // spheres within reach, mean of the poses
    kTies,        // answers that differ within 1 um of the limit
    kFromOurs,    // [mm] RMS of depth against our answer, away from edges
    kFromTruth,   // [mm] RMS of depth against the exact surface, away from edges
    kPeerColumns
};
inline StudyRow peerRow(std::string source, std::string setting) {
    StudyRow row;
    row.source = std::move(source), row.setting = std::move(setting);
    row.more.assign(kPeerColumns, std::numeric_limits<double>::quiet_NaN());
    return row;
}
// Ratios of all rows from `first` on to row `ours`, and to the submit-to-result of row `gpu`.
void fillRatios(std::vector<StudyRow>& rows, size_t first, size_t ours, size_t gpu);
// The time that the study compares [ms]: of the device for a pass of ours, CPU time for a contact query on
// the asking thread, else wall time.
double peerTime(const StudyRow& row);
// Threads of the device in use, not a number for a GPU.
double deviceThreads(const gpu::Device& device);

// Each appends its rows; ours come first in each source. Throws Error where an answer of ours is wrong.
void addPeerFilters(const StudyContext& context, std::vector<StudyRow>& rows);
void addPeerPoints(const StudyContext& context, std::vector<StudyRow>& rows);
void addPeerCollision(const StudyContext& context, std::vector<StudyRow>& rows);

// "contact 10.24 k spheres" + " x 64 leaves": what the images are drawn by.
inline constexpr const char* kContactPrefix = "contact ";

} // namespace fathom::profile
