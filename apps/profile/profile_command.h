// SPDX-License-Identifier: Apache-2.0
// `fathom profile [STUDY...]`: measures error against run time and writes tables, plots and a report.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

void addProfileCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
