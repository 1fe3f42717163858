// SPDX-License-Identifier: Apache-2.0
// New-data cases of whole streams: dropouts, flicker, noise, walls that close in on the tool, recordings.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addStreamCases(std::vector<Case>& cases);

} // namespace fathom::stability
