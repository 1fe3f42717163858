// SPDX-License-Identifier: Apache-2.0
// Geometry cases against the exact geometry of analytic scenes, and cases of a tool at rest in tight places.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addTruthCases(std::vector<Case>& cases);

} // namespace fathom::stability
