// SPDX-License-Identifier: Apache-2.0
// `fathom arm-simulator`: an arm that is not there, behind a pseudo-terminal, for `--arm` to drive.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addArmSimulatorCommand(CLI::App& app);

} // namespace fathom
