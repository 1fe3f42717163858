// SPDX-License-Identifier: Apache-2.0
// Table and plot of the points that `fathom tune` measured.
#pragma once

#include "apps/output/image.h"
#include "apps/tune/tuner.h"
#include "engine/types/output_file.h"

#include <string>

namespace fathom::tune {

// One row per point, without commit. Throws Error that names the file.
void writePoints(const TuneResult& result, const Request& request, OutputFile& out);

// Error and vibration against time, the Pareto front, the limit that was asked for, and the chosen point.
Image curveOf(const TuneResult& result, const Request& request, const std::string& title,
              const std::string& subtitle);

} // namespace fathom::tune
