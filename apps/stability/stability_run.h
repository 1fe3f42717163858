// SPDX-License-Identifier: Apache-2.0
// Lists all cases, selects the requested ones and runs a case.
#pragma once

#include "apps/stability/stability_case.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace fathom::stability {

// All cases in the order of their groups. Precision cases call `device` when they run. Throws Error when two
// cases share a name.
std::vector<Case> allCases(const DeviceSource& device);

// The cases with these names or group names, in the order of `all`; all cases if `names` is empty. Throws
// BadInput with the names of the groups when a name is unknown.
std::vector<Case> chosenCases(const std::vector<Case>& all, const std::vector<std::string>& names);

// One line per case: its group and its name.
void listCases(std::ostream& out, const std::vector<Case>& cases);

struct CaseResult {
    std::string name;
    Group group = Group::Solver;
    Outcome outcome;
    double seconds = 0.0; // wall clock
};

// A case that throws Error counts as failed, with the message in its note.
CaseResult runCase(const Case& one, RunLength runLength);

// "0.00123 <= 0.01 m"
std::string comparison(const Outcome& outcome);

} // namespace fathom::stability
