// SPDX-License-Identifier: Apache-2.0
// The plots of the suite: how far every case is from its limit, and the curves that cases return.
#pragma once

#include "apps/stability/stability_run.h"

#include <filesystem>
#include <vector>

namespace fathom::stability {

// margins.png: a bar per case, figure over limit on a logarithmic axis, by group; red beyond 1. CASE.png for
// every case with curves: its curves over their axes with units, linear or logarithmic. Files of an earlier
// run are replaced. Throws Error that names the file.
void writePlots(const std::filesystem::path& folder, const std::vector<CaseResult>& results);

} // namespace fathom::stability
