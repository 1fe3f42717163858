// SPDX-License-Identifier: Apache-2.0
// `fathom arm-guardian PROTOCOL`: the watchdog process that the program starts for a real arm
// (apps/binding/arm_watchdog.h). Not for manual use.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addArmWatchdogCommand(CLI::App& app);

} // namespace fathom
