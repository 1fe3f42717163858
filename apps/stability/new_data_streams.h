// SPDX-License-Identifier: Apache-2.0
// New-data cases on frame streams: dropouts, flicker, noise, walls that close in on the tool, and recordings.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addStreamCases(std::vector<Case>& cases);

} // namespace fathom::stability
