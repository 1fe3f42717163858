// SPDX-License-Identifier: Apache-2.0
// Group precision on a chosen device.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

// selector: as gpu::Device takes it; empty = the best device there is. precisionCases() is this with an empty
// one.
std::vector<Case> precisionCases(const std::string& selector);

} // namespace fathom::stability
