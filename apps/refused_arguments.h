// SPDX-License-Identifier: Apache-2.0
// Command-line errors as one line: option or subcommand, value, what is allowed.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace fathom {

// app: that failed to parse with `error`.
std::string refusalOf(const CLI::App& app, const CLI::ParseError& error);

} // namespace fathom
