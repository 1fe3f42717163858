// SPDX-License-Identifier: Apache-2.0
// Checks of command-line options whose message names value and allowed values.
#pragma once

#include "engine/scene/yaml_node.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

// Accepts one of the words.
inline CLI::Validator wordIn(std::vector<std::string> words) {
    const auto check = [words = std::move(words)](const std::string& text) -> std::string {
        std::string allowed;
        for (const std::string& word : words) {
            if (word == text) {
                return "";
            }
            allowed += (allowed.empty() ? "" : ", ") + word;
        }
        return text + " (allowed: " + allowed + ")";
    };
    return CLI::Validator(check, "");
}

} // namespace fathom
