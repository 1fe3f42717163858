// SPDX-License-Identifier: Apache-2.0
// Reports a latency run: text lines, a table of histograms, JSON.
#pragma once

#include "apps/latency/latency_run.h"

#include <iosfwd>
#include <span>

namespace fathom {

inline constexpr double kMaxGrowth = 8.0; // [MiB] allowed growth of resident memory in a soak

void printLatency(std::ostream& out, const LatencyPart& part);
// One row per range in 1-2-5 steps, one column per part and kind. Skips empty rows at both ends.
void printHistograms(std::ostream& out, std::span<const LatencyPart> parts);
// endedBySignal: parts are missing or cut. Throws Error when the file cannot be written.
void writeLatency(const std::filesystem::path& file, std::span<const LatencyPart> parts, double rateHz,
                  const std::string& device, bool endedBySignal);
// True when the part ran for the requested time [s], processed frames, lost no frame and no record, and
// memory was measured and did not grow.
bool soakHolds(const LatencyPart& part, double required);

} // namespace fathom
