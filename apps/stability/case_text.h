// SPDX-License-Identifier: Apache-2.0
// Formatting for the notes of cases, and extra conditions that a case must meet besides its limit.
#pragma once

#include "apps/stability/stability_case.h"
#include "engine/types/number_text.h"

#include <limits>
#include <string>
#include <utility>

namespace fathom::stability {

// Formats with four significant digits.
inline std::string num(double value) {
    return significant(value, 4);
}
inline std::string num(uint64_t value) {
    return std::to_string(value);
}

inline Outcome outcomeOf(double figure, double limit, std::string unit, std::string note) {
    Outcome out;
    out.figure = figure;
    out.limit = limit;
    out.unit = std::move(unit);
    out.note = std::move(note);
    return out;
}

// An extra condition. On failure the figure becomes NaN, so the case fails, and the note gives the reason.
inline void require(Outcome& outcome, bool holds, const std::string& what) {
    if (!holds) {
        outcome.figure = std::numeric_limits<double>::quiet_NaN();
        outcome.note += " FAILED: " + what + ".";
    }
}

} // namespace fathom::stability
