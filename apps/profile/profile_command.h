// SPDX-License-Identifier: Apache-2.0
// `fathom profile [STUDY...]`: error against run time, as files that show it.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

void addProfileCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
