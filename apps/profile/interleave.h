// SPDX-License-Identifier: Apache-2.0
// Interleaved measurement: measures all settings in alternating parts, so that drift of the machine affects
// all of them equally.
#pragma once

#include "apps/profile/frame_bench.h"

#include <functional>
#include <memory>
#include <vector>

namespace fathom::profile {

inline constexpr size_t kInterleaveRounds = 4;

// Calls work(i, part) for all i in 0 .. count - 1 per round, every other round in reverse order. part: the
// repeats of one round.
template <class Work>
void interleave(const Repeats& repeats, size_t count, Work&& work) {
    const Repeats part{(repeats.least + kInterleaveRounds - 1) / kInterleaveRounds,
                       (repeats.most + kInterleaveRounds - 1) / kInterleaveRounds,
                       repeats.seconds / kInterleaveRounds};
    for (size_t round = 0; round < kInterleaveRounds; ++round) {
        for (size_t k = 0; k < count; ++k) {
            work(round % 2 == 0 ? k : count - 1 - k, part);
        }
    }
}

// Wall and CPU time of each work, interleaved. For CPU work without waiting.
std::vector<Cost> timeCpuInterleaved(const Repeats& repeats, const std::vector<std::function<void()>>& works);

// Runs the same frames through every bench, interleaved.
std::vector<FrameCost> measureInterleaved(const std::vector<std::unique_ptr<FrameBench>>& benches,
                                          const std::vector<SampleFrame>& frames, const Repeats& repeats);

} // namespace fathom::profile
