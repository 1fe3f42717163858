// SPDX-License-Identifier: Apache-2.0
// Runs every case of one group in its short form and checks each against its limit.
#pragma once

#include "apps/stability/stability_run.h"

#include <doctest/doctest.h>

namespace fathom::testing {

inline void checkGroup(const std::vector<stability::Case>& cases, stability::Group group, size_t atLeast) {
    CHECK(cases.size() >= atLeast);
    double seconds = 0.0;
    for (const stability::Case& one : cases) {
        CHECK(one.group == group);
        const stability::CaseResult result = stability::runCase(one, stability::RunLength::Short);
        seconds += result.seconds;
        CAPTURE(one.name);
        CAPTURE(stability::comparison(result.outcome));
        CAPTURE(result.outcome.note);
        CHECK(result.outcome.holds());
        CHECK(!result.outcome.note.empty());
        CHECK(!result.outcome.unit.empty());
    }
    MESSAGE(cases.size() << " cases in " << seconds << " s");
}

} // namespace fathom::testing
