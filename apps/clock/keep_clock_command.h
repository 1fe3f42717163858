// SPDX-License-Identifier: Apache-2.0
// The process behind --hold-clock (clock_keeper.h). The program starts it by itself: it is in no help.
#pragma once

#include <CLI/CLI.hpp>

namespace fathom {

void addKeepClockCommand(CLI::App& app);

} // namespace fathom
