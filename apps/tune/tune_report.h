// SPDX-License-Identifier: Apache-2.0
// Table and plot of the points that `fathom tune` measured.
#pragma once

#include "apps/tune/tuner.h"

#include <filesystem>
#include <string>

namespace fathom::tune {

// One row per point. Throws Error that names the file.
void writePoints(const TuneResult& result, const Request& request, const std::filesystem::path& file);

// Error and vibration against time, the Pareto front, the limit that was asked for, and the chosen point.
// Throws Error that names the file.
void writeCurve(const TuneResult& result, const Request& request, const std::string& title,
                const std::string& subtitle, const std::filesystem::path& file);

} // namespace fathom::tune
