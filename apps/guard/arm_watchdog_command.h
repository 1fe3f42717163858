// SPDX-License-Identifier: Apache-2.0
// `fathom arm-guardian PROTOCOL`: what the program starts beside itself for a real arm
// (apps/binding/arm_watchdog.h). Nobody types it.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addArmWatchdogCommand(CLI::App& app);

} // namespace fathom
