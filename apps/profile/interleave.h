// SPDX-License-Identifier: Apache-2.0
// Settings measured in turns, a part of each at a time, so that what drifts on a machine falls on all alike.
#pragma once

#include "apps/profile/frame_bench.h"

#include <functional>
#include <memory>
#include <vector>

namespace fathom::profile {

inline constexpr size_t kInterleaveRounds = 4;

// work(i, part) of things 0 .. count - 1, all of them a round, every other round backwards: part is the
// effort of one round.
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

// CPU work that waits for nobody: wall and CPU time of each.
std::vector<Cost> timeCpuInterleaved(const Repeats& repeats, const std::vector<std::function<void()>>& works);

// The same shots through every bench.
std::vector<FrameCost> measureInterleaved(const std::vector<std::unique_ptr<FrameBench>>& benches,
                                          const std::vector<SampleFrame>& frames, const Repeats& repeats);

} // namespace fathom::profile
