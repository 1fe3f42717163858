// SPDX-License-Identifier: Apache-2.0
// Lines of the program's log, by spdlog's default logger. Its templates stay in one file: compiled into every
// file that writes a line they are a tenth of a whole build, and a fifth of one under sanitizers.
#pragma once

#include <fmt/core.h>

namespace fathom::log {

// How much a line matters.
enum class Level { Debug, Info, Warning, Error };

// Any thread but the haptic one: it makes a text, takes the logger's lock and writes.
void write(Level level, fmt::string_view format, fmt::format_args values);

// Placeholders are checked against the values by the compiler.
template <class... Values>
void debug(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Debug, format, fmt::make_format_args(values...));
}
template <class... Values>
void info(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Info, format, fmt::make_format_args(values...));
}
template <class... Values>
void warn(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Warning, format, fmt::make_format_args(values...));
}
template <class... Values>
void error(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Error, format, fmt::make_format_args(values...));
}

} // namespace fathom::log
