// SPDX-License-Identifier: Apache-2.0
// The sizes at which one contact query method becomes faster than another, from the query study's rows, and
// the resulting choice of `contact.where: auto`.
#pragma once

#include "apps/profile/query_rows.h"
#include "engine/types/device_facts.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fathom::profile {

// p50 times [ms] of two methods for the same work of one size.
struct TimePair {
    double size = 0.0, first = 0.0, second = 0.0;
};
struct Crossing {
    // Smallest size from which the second method is faster at every size; infinity = none.
    double from = std::numeric_limits<double>::infinity();
    std::vector<double> before; // ascending: smaller sizes at which it is faster in every pair, too
};
Crossing crossingOf(const std::vector<TimePair>& pairs);

// Smallest leaf count at which the device was faster than the CPU in every set, also for every larger tool.
// kNeverOnGpu if there is none.
uint32_t leavesForTheDevice(const std::vector<StudyRow>& rows);

// Sentences on the crossings. For each set the leaf count, and for each tool the sphere count, from which the
// device builds the contact set faster than the CPU. Also the number of spheres x leaves from which a cull by
// grid or by device tree is faster than brute force.
std::vector<std::string> crossingFindings(const std::vector<StudyRow>& rows);

// A sentence that says for which of these tools `where: auto` uses such a device, according to the resulting
// plan.
std::string autoDecision(const DeviceFacts& device, const std::vector<uint32_t>& toolLeaves);

} // namespace fathom::profile
