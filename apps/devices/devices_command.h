// SPDX-License-Identifier: Apache-2.0
// `fathom devices`: what is plugged in, what it can do, and why something cannot be used.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

void addDevicesCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
