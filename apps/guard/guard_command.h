// SPDX-License-Identifier: Apache-2.0
// `fathom guard falcon`: the watchdog process that owns a haptic device, so that no crash of the engine
// leaves a force on the hand.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addGuardCommand(CLI::App& app);

} // namespace fathom
