// SPDX-License-Identifier: Apache-2.0
// `fathom stability [CASE...] --out DIR`: runs the stiff and extreme cases and checks each against its limit.
// `fathom stability [CASE...] --list` lists them.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

// result: 0 if every case holds, otherwise 1.
void addStabilityCommand(CLI::App& app, const GlobalOptions& global, int& result);

} // namespace fathom
