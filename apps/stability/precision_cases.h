// SPDX-License-Identifier: Apache-2.0
// Group precision on a selected device.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

// selector: as for gpu::Device; empty = the best available device, which precisionCases() uses.
std::vector<Case> precisionCases(const std::string& selector);

} // namespace fathom::stability
