// SPDX-License-Identifier: Apache-2.0
// Geometry cases against the exact truth of analytic scenes, and the tool at rest in places without room.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addTruthCases(std::vector<Case>& cases);

} // namespace fathom::stability
