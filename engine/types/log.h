// SPDX-License-Identifier: Apache-2.0
// Writes the program's log through spdlog's default logger. spdlog's templates are confined to log.cpp,
// because including them everywhere takes a tenth of the build time.
#pragma once

#include <fmt/core.h>

namespace fathom::log {

// Severity of a line. Progress: Info that is shown without --verbose, of work that keeps the user waiting.
enum class Level { Debug, Info, Warning, Error, Progress };

// Any thread except the haptic one: formats a text, takes the logger's lock and writes.
void write(Level level, fmt::string_view format, fmt::format_args values);

// The compiler checks placeholders against the values.
template <class... Values>
void debug(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Debug, format, fmt::make_format_args(values...));
}
template <class... Values>
void info(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Info, format, fmt::make_format_args(values...));
}
template <class... Values>
void progress(fmt::format_string<Values...> format, Values&&... values) {
    write(Level::Progress, format, fmt::make_format_args(values...));
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
