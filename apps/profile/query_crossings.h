// SPDX-License-Identifier: Apache-2.0
// Where one way of answering a contact query becomes faster than another, by what the query study measured,
// and what `contact.where: auto` makes of it.
#pragma once

#include "apps/profile/query_rows.h"
#include "engine/types/device_facts.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fathom::profile {

// Two ways that did the same work of some size, p50 [ms].
struct Duel {
    double size = 0.0, incumbent = 0.0, challenger = 0.0;
};
struct Crossing {
    double from = std::numeric_limits<double>::infinity(); // the challenger is faster in every duel of this
                                                           // size or a larger one; infinity = never
    std::vector<double> before; // ascending: smaller sizes where it was faster in every duel all the same
};
Crossing crossingOf(const std::vector<Duel>& duels);

// Fewest tool leaves from which on the device made the contact set faster than the CPU, in every set and with
// every larger tool; gpu::kNeverOnGpu where there are none.
uint32_t leavesForTheDevice(const std::vector<StudyRow>& rows);

// In words: of each set from how many leaves on, and of each tool from how many region spheres on, the device
// makes the contact set faster than the CPU; from how many spheres x leaves on the cull by the grid, and by
// the device's tree, beats brute force.
std::vector<std::string> crossingFindings(const std::vector<StudyRow>& rows);

// In words: with which of these tools `where: auto` asks such a device, by the plan that it would get.
std::string autoDecision(const DeviceFacts& device, const std::vector<uint32_t>& toolLeaves);

} // namespace fathom::profile
