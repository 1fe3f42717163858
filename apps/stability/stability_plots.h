// SPDX-License-Identifier: Apache-2.0
// The suite's plots: the margin of every case to its limit, and the curves that cases return.
#pragma once

#include "apps/stability/stability_run.h"

#include <filesystem>
#include <vector>

namespace fathom::stability {

// Writes margins.png: one bar per case with figure over limit on a logarithmic axis, by group, red above 1.
// Writes CASE.png for every case with curves, on linear or logarithmic axes with units. Replaces files of an
// earlier run. Throws Error that names the file.
void writePlots(const std::filesystem::path& folder, const std::vector<CaseResult>& results);

} // namespace fathom::stability
