// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/trace_phases.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kFlickerShare = 0.02;
constexpr size_t kSlots = 1000; // time resolution of the phases; bounds the work of merging

PhaseKind kindOf(const TraceBin& bin) {
    if (bin.in(StepState::Trapped) > 0) {
        return PhaseKind::Trapped;
    }
    if (2 * bin.in(StepState::Off) > bin.ticks) {
        return PhaseKind::Off;
    }
    if (2 * bin.in(StepState::Fading) > bin.ticks) {
        return PhaseKind::Fading;
    }
    if (bin.guidance > 0.0) {
        return PhaseKind::Guidance;
    }
    const bool touching = bin.in(StepState::Contact) + bin.in(StepState::Escape) > 0;
    return touching ? PhaseKind::Contact : PhaseKind::Free;
}

void append(std::vector<Phase>& phases, const Phase& next) {
    if (!phases.empty() && phases.back().kind == next.kind) {
        phases.back().end = next.end;
    } else {
        phases.push_back(next);
    }
}

// Runs of equal kind over at most kSlots groups of bins; a group has the kind of most of its bins.
std::vector<Phase> runs(const std::vector<TraceBin>& bins) {
    std::vector<Phase> phases;
    const size_t group = (bins.size() + kSlots - 1) / kSlots;
    for (size_t first = 0; first < bins.size(); first += group) {
        const size_t last = std::min(first + group, bins.size());
        std::array<size_t, 6> votes{};
        for (size_t i = first; i < last; ++i) {
            ++votes[static_cast<size_t>(kindOf(bins[i]))];
        }
        const auto winner = std::ranges::max_element(votes) - votes.begin();
        const double end = last < bins.size() ? bins[last].begin : bins.back().end;
        append(phases, {bins[first].begin, end, static_cast<PhaseKind>(winner)});
    }
    return phases;
}

// Merges the phase at `index` into its longer neighbour, and then neighbours of the same kind.
void absorb(std::vector<Phase>& phases, size_t index) {
    const auto length = [&](size_t i) { return phases[i].end - phases[i].begin; };
    const bool hasLeft = index > 0;
    const bool hasRight = index + 1 < phases.size();
    const bool left = hasLeft && (!hasRight || length(index - 1) >= length(index + 1));
    phases[index].kind = phases[left ? index - 1 : index + 1].kind;
    std::vector<Phase> joined;
    for (const Phase& phase : phases) {
        append(joined, phase);
    }
    phases = std::move(joined);
}

} // namespace

const char* phaseName(PhaseKind kind) {
    constexpr const char* kNames[] = {"off", "free", "contact", "guidance", "fading", "trapped"};
    return kNames[static_cast<size_t>(kind)];
}

std::vector<Phase> findPhases(const TraceHistory& history, size_t most) {
    const auto& bins = history.bins();
    if (bins.empty()) {
        return {};
    }
    std::vector<Phase> phases = runs(bins);
    const double flicker = kFlickerShare * (bins.back().end - bins.front().begin);
    while (phases.size() > 1) {
        const auto shortest = std::ranges::min_element(
            phases, [](const Phase& a, const Phase& b) { return a.end - a.begin < b.end - b.begin; });
        if (shortest->end - shortest->begin >= flicker && phases.size() <= most) {
            break;
        }
        absorb(phases, static_cast<size_t>(shortest - phases.begin()));
    }
    return phases;
}

} // namespace fathom
