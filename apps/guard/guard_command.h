// SPDX-License-Identifier: Apache-2.0
// `fathom guard falcon`: the small process that owns a haptic device, so that no end of the engine leaves a
// force on the hand.
#pragma once

#include <CLI/CLI.hpp>

namespace fathom {

void addGuardCommand(CLI::App& app);

} // namespace fathom
