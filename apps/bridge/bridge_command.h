// SPDX-License-Identifier: Apache-2.0
// `fathom guard falcon`: the bridge of a haptic device, so that no crash of the engine leaves a force on the
// hand.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addBridgeCommand(CLI::App& app);

} // namespace fathom
