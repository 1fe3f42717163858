// SPDX-License-Identifier: Apache-2.0
// Which cases there are, which were asked for, and how one is run.
#pragma once

#include "apps/stability/stability_case.h"

#include <string>
#include <vector>

namespace fathom::stability {

// Every case of the nine groups, in their order. `device` is called while precision cases run. Throws Error
// when two share a name.
std::vector<Case> allCases(const DeviceSource& device);

// Those named, or of the groups named, in the order of `all`; all when nothing is named. Throws BadInput that
// lists the known names when one is unknown.
std::vector<Case> chosenCases(const std::vector<Case>& all, const std::vector<std::string>& names);

struct CaseResult {
    std::string name;
    Group group = Group::Solver;
    Outcome outcome;
    double seconds = 0.0; // wall clock
};

// A case that throws an Error counts as one that does not hold, with the message in its note.
CaseResult runCase(const Case& one, RunLength runLength);

// "0.00123 <= 0.01 m"
std::string comparison(const Outcome& outcome);

} // namespace fathom::stability
