// SPDX-License-Identifier: Apache-2.0
// The times of the frames of a recording folder, where its stamps do not rise.
#pragma once

#include "devices/recorded/recording_layout.h"

namespace fathom {

// Median of the times between usable frames [s]; 0 for a single frame. A mean would follow a single pause.
double medianPeriod(const std::vector<IndexLine>& index);

// Whether all stamps are whole numbers that mostly rise by 1, as those of a simulated sequence that counts
// its frames; false for fewer than ten frames.
bool countFrames(const std::vector<IndexLine>& index);

// Single stamps that go back are faults of their frames and stay. Where at least half do not rise, they are
// no times: frames get 30 per second in the order of the index. Where the clock was set back, frames continue
// one period after the last one, unless poses.txt is read by stamps. Returns what was changed, logged
// already. Throws BadInput where no stamps are times and poses.txt needs them.
std::vector<std::string> settleTimes(RecordingLayout& layout, const std::filesystem::path& folder);

} // namespace fathom
