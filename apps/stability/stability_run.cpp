// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/stability_run.h"

#include "apps/stability/case_text.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/suggestion.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <iterator>
#include <limits>
#include <ostream>
#include <set>

namespace fathom::stability {

namespace {

const char* nameOfGroup(Group group) {
    return kGroupNames[static_cast<size_t>(group)];
}

std::string groupNames() {
    return joined(kGroupNames);
}

} // namespace

std::vector<Case> allCases(const DeviceSource& device) {
    std::array groups{solverCases(),   geometryCases(), guaranteeCases(),       newDataCases(), stiffCases(),
                      rotationCases(), guidanceCases(), precisionCases(device), longRunCases(), feelCases()};
    std::vector<Case> all;
    std::set<std::string> names;
    for (std::vector<Case>& group : groups) {
        for (Case& c : group) {
            if (!names.insert(c.name).second) {
                throw Error("stability: two cases are called " + c.name);
            }
            all.push_back(std::move(c));
        }
    }
    return all;
}

std::vector<Case> chosenCases(const std::vector<Case>& all, const std::vector<std::string>& names) {
    if (names.empty()) {
        return all;
    }
    for (const std::string& name : names) {
        const bool exists = std::ranges::any_of(
            all, [&](const Case& c) { return c.name == name || nameOfGroup(c.group) == name; });
        if (!exists) {
            std::vector<std::string_view> known(std::begin(kGroupNames), std::end(kGroupNames));
            std::ranges::transform(all, std::back_inserter(known), &Case::name);
            throw BadInput("stability", "CASE", "'" + name + "'" + suggestion(name, known),
                           "a group (" + groupNames() + ") or a case that fathom stability --list prints");
        }
    }
    std::vector<Case> chosen;
    for (const Case& c : all) {
        if (std::ranges::any_of(names, [&](const std::string& name) {
                return c.name == name || nameOfGroup(c.group) == name;
            })) {
            chosen.push_back(c);
        }
    }
    return chosen;
}

void listCases(std::ostream& out, const std::vector<Case>& cases) {
    for (const Case& c : cases) {
        out << std::left << std::setw(10) << nameOfGroup(c.group) << c.name << "\n";
    }
}

CaseResult runCase(const Case& one, RunLength runLength) {
    CaseResult result{one.name, one.group, {}, 0.0};
    const auto start = Clock::now();
    try {
        result.outcome = one.run(runLength);
    } catch (const Error& e) {
        result.outcome = outcomeOf(std::numeric_limits<double>::quiet_NaN(), 0.0, "1", "");
        require(result.outcome, false, e.what());
    }
    result.seconds = secondsSince(start);
    return result;
}

std::string comparison(const Outcome& outcome) {
    const std::string unit = outcome.unit == "1" ? "" : " " + outcome.unit;
    return num(outcome.figure) + " " + outcome.relation + " " + num(outcome.limit) + unit;
}

} // namespace fathom::stability
