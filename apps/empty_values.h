// SPDX-License-Identifier: Apache-2.0
// Options whose value is empty.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace fathom {

// Rejects empty values of the app's options, as unset shell variables give them. Required options have
// messages of their own, which say what they need.
inline void refuseEmptyValues(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        if (option->get_items_expected_max() == 0 || option->get_required()) { // 0: a flag
            continue;
        }
        const std::string allowed = "a value, or no " + option->get_name();
        const auto check = [allowed](const std::string& text) -> std::string {
            return text.empty() ? "value: empty (allowed: " + allowed + ")" : "";
        };
        option->check(CLI::Validator(check, ""));
    }
}

} // namespace fathom
