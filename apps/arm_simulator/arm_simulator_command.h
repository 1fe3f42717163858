// SPDX-License-Identifier: Apache-2.0
// `fathom arm-simulator`: a simulated arm on a pseudo-terminal, for use with `--arm`.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addArmSimulatorCommand(CLI::App& app);

} // namespace fathom
