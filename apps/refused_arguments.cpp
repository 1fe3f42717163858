// SPDX-License-Identifier: Apache-2.0
#include "apps/refused_arguments.h"

#include "engine/types/joined.h"
#include "engine/types/lower_case.h"
#include "engine/types/suggestion.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <vector>

namespace fathom {

namespace {

using Names = std::vector<std::string>;
constexpr const char* kSeeHelp = "; see fathom --help";

std::string unknown(const std::string& word, const Names& names) {
    const std::string small = lowerCase(word); // as all names are
    return "'" + word + "'" + suggestion(small, std::vector<std::string_view>(names.begin(), names.end())) +
           " (allowed: " + joined(names) + ")";
}

Names commandsOf(const CLI::App& app) {
    Names names;
    for (const CLI::App* command : app.get_subcommands(nullptr)) {
        if (!command->get_group().empty()) { // internal commands have no group
            names.push_back(command->get_name());
        }
    }
    return names;
}

// Of the subcommand, then of the program.
Names optionsOf(const CLI::App* command, const CLI::App& app) {
    Names names;
    for (const CLI::App* owner : {command, &app}) {
        if (owner == nullptr) {
            continue;
        }
        for (const CLI::Option* option : owner->get_options()) {
            if (command == nullptr || owner == command || option != app.get_help_ptr()) { // both have --help
                names.push_back(option->get_name());
            }
        }
    }
    return names;
}

// Why no subcommand was found.
std::string withoutCommand(const CLI::App& app, const CLI::ParseError& error, const Names& rest) {
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        const std::string text = error.what();
        for (const CLI::Option* option : app.get_options()) {
            if (text.find(option->get_name() + ":") == 0) {
                return option->get_name() + ": value missing (" + option->get_description() + ")";
            }
        }
        return text;
    }
    const Names commands = commandsOf(app);
    if (rest.empty()) {
        return "subcommand: missing (allowed: " + joined(commands) + ")" + kSeeHelp;
    }
    const std::string& word = rest.front();
    if (word.find('-') == 0) {
        return "option: " + unknown(word, optionsOf(nullptr, app)) + kSeeHelp;
    }
    if (std::filesystem::path(word).extension() == ".yaml") {
        return "subcommand: missing before '" + word + "' (for example: fathom replay " + word +
               " --out DIR)" + kSeeHelp;
    }
    return "subcommand: " + unknown(word, commands) + kSeeHelp;
}

// Why a subcommand does not take this word.
std::string notTaken(const CLI::App& command, const CLI::App& app, const std::string& word) {
    const std::string name = command.get_name();
    const CLI::Option* const option = command.get_option_no_throw(word);
    if (option != nullptr && !option->get_positional()) {
        return name + ": " + word + ": before the subcommand (allowed: after it: fathom " + name + " " +
               word + " ...)";
    }
    for (const CLI::Option* positional : command.get_options()) {
        const std::string title = positional->get_name();
        if (!positional->get_positional()) {
            continue;
        }
        if (word.find('-') != 0 && positional->count() > 0) {
            return name + ": '" + word + "': one " + title + " only";
        }
        if (word == "--" + lowerCase(title)) {
            return name + ": " + word + ": " + title + " is given without an option (fathom " + name + " " +
                   title + ")";
        }
    }
    return name + ": " + unknown(word, optionsOf(&command, app));
}

} // namespace

std::string refusalOf(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const Names rest = app.remaining(true);
    if (chosen.empty()) {
        return withoutCommand(app, error, rest);
    }
    if (!rest.empty()) {
        return notTaken(*chosen.back(), app, rest.front());
    }
    const std::string name = chosen.back()->get_name();
    std::string text = name + ": " + error.what() + "; see fathom " + name + " --help";
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

} // namespace fathom
