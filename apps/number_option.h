// SPDX-License-Identifier: Apache-2.0
// Checks of command-line options whose message names value and allowed values.
#pragma once

#include "engine/scene/yaml_node.h"
#include "engine/types/joined.h"
#include "engine/types/parse_number.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Accepts a decimal number in the range. CLI::Range accepts NaN, because NaN is neither below nor above a
// bound.
inline CLI::Validator numberIn(const Range& range) {
    const auto check = [range](const std::string& text) -> std::string {
        std::string_view digits = text;
        digits.remove_prefix(digits.starts_with('+') ? 1 : 0);
        double x = 0.0;
        const bool good = parseWhole(digits, x) && range.contains(x);
        return good ? "" : text + " (allowed: " + range.words() + ")";
    };
    return CLI::Validator(check, "");
}

// Accepts a whole number in the range, for an option that is an integer.
inline CLI::Validator wholeNumberIn(uint32_t least, uint32_t most) {
    const auto check = [least, most](const std::string& text) -> std::string {
        uint32_t n = 0;
        const bool good = parseWhole(text, n) && n >= least && n <= most;
        return good ? ""
                    : text + " (allowed: a whole number from " + std::to_string(least) + " to " +
                          std::to_string(most) + ")";
    };
    return CLI::Validator(check, "");
}

// Accepts one of the words. The help shows them behind the option's type.
inline CLI::Validator wordIn(const std::vector<std::string>& words) {
    const auto check = [words](const std::string& text) -> std::string {
        const bool known = std::find(words.begin(), words.end(), text) != words.end();
        return known ? "" : text + " (allowed: " + joined(words) + ")";
    };
    return CLI::Validator(check, "{" + CLI::detail::join(words, ",") + "}");
}

} // namespace fathom
