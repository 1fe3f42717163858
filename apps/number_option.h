// SPDX-License-Identifier: Apache-2.0
// The range check of numeric command-line options.
#pragma once

#include "engine/scene/yaml_node.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>
#include <string_view>

namespace fathom {

// Accepts a decimal number in the range. CLI::Range accepts NaN, because NaN is neither below nor above a
// bound.
inline CLI::Validator numberIn(const Range& range) {
    const auto check = [range](const std::string& text) -> std::string {
        std::string_view digits = text;
        digits.remove_prefix(digits.starts_with('+') ? 1 : 0);
        double x = 0.0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
        const bool good = error == std::errc{} && end == digits.data() + digits.size() && range.contains(x);
        return good ? "" : text + " (allowed: " + range.words() + ")";
    };
    return CLI::Validator(check, "");
}

} // namespace fathom
