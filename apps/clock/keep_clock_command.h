// SPDX-License-Identifier: Apache-2.0
// The process behind --hold-clock (clock_keeper.h). Started by the program itself and hidden from the help.
#pragma once

#include <CLI/CLI.hpp>

namespace fathom {

void addKeepClockCommand(CLI::App& app);

} // namespace fathom
