// SPDX-License-Identifier: Apache-2.0
// What a latency run tells: lines, histograms side by side, JSON.
#pragma once

#include "apps/latency/latency_run.h"

#include <iosfwd>
#include <span>

namespace fathom {

inline constexpr double kMostGrowth =
    8.0; // [MiB] of resident memory over a soak: what allocators keep and give back

void printLatency(std::ostream& out, const LatencyPart& part);
// A row a range of 1-2-5 steps, a column per part and kind; rows that nothing fell in at either end are left
// out.
void printHistograms(std::ostream& out, std::span<const LatencyPart> parts);
// Throws Error when it cannot be written.
void writeLatency(const std::filesystem::path& file, std::span<const LatencyPart> parts, double rateHz,
                  const std::string& device);
// As long as was asked [s] and with frames, no frame lost, no record lost, memory looked at and flat.
bool soakHolds(const LatencyPart& part, double asked);

} // namespace fathom
