// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/turns.h"

namespace fathom::profile {

std::vector<Cost> timeCpuInTurns(const Effort& effort, const std::vector<std::function<void()>>& works) {
    std::vector<CpuSamples> samples(works.size());
    inTurns(effort, works.size(), [&](size_t i, const Effort& part) {
        repeat(part, works[i], [&](const Clocks& clocks) { samples[i].take(clocks); });
    });
    std::vector<Cost> costs;
    for (const CpuSamples& s : samples) {
        costs.push_back(s.cost());
    }
    return costs;
}

std::vector<FrameCost> measureInTurns(const std::vector<std::unique_ptr<FrameBench>>& benches,
                                      const std::vector<Shot>& shots, const Effort& effort) {
    std::vector<FrameSamples> samples(benches.size());
    inTurns(effort, benches.size(),
            [&](size_t i, const Effort& part) { benches[i]->sample(shots, part, samples[i]); });
    std::vector<FrameCost> costs;
    for (size_t i = 0; i < benches.size(); ++i) {
        costs.push_back(benches[i]->costOf(samples[i]));
    }
    return costs;
}

} // namespace fathom::profile
