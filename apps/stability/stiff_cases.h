// SPDX-License-Identifier: Apache-2.0
// The parts of the group stiff, one per file. stiffCases() joins them.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

std::vector<Case> boundaryCases();   // measured K_max against theory
std::vector<Case> settlingCases();   // automatic stiffness: nothing oscillates
std::vector<Case> energyCases();     // static fixtures generate no energy
std::vector<Case> pathCases();       // closed paths of the hand draw no energy
std::vector<Case> controllerCases(); // moving fixtures, controller on and off, slow ticks

} // namespace fathom::stability
