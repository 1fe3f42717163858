// SPDX-License-Identifier: Apache-2.0
// The parts of the group guidance, one per file. guidanceCases() joins them.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

std::vector<Case> guidancePlaneCases(); // from points to a pose

} // namespace fathom::stability
