// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/interleave.h"

namespace fathom::profile {

std::vector<Cost> timeCpuInterleaved(const Repeats& repeats,
                                     const std::vector<std::function<void()>>& works) {
    std::vector<CpuSamples> samples(works.size());
    interleave(repeats, works.size(), [&](size_t i, const Repeats& part) {
        repeat(part, works[i], [&](const Clocks& clocks) { samples[i].take(clocks); });
    });
    std::vector<Cost> costs;
    for (const CpuSamples& s : samples) {
        costs.push_back(s.cost());
    }
    return costs;
}

std::vector<FrameCost> measureInterleaved(const std::vector<std::unique_ptr<FrameBench>>& benches,
                                          const std::vector<SampleFrame>& frames, const Repeats& repeats) {
    std::vector<FrameSamples> samples(benches.size());
    interleave(repeats, benches.size(),
               [&](size_t i, const Repeats& part) { benches[i]->sample(frames, part, samples[i]); });
    std::vector<FrameCost> costs;
    for (size_t i = 0; i < benches.size(); ++i) {
        costs.push_back(benches[i]->costOf(samples[i]));
    }
    return costs;
}

} // namespace fathom::profile
