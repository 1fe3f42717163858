// SPDX-License-Identifier: Apache-2.0
// `fathom stability [CASE...] --out DIR`: the stiff and extreme cases, measured against their stated limits.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

// result: 0 when every case holds, 1 when one does not.
void addStabilityCommand(CLI::App& app, const GlobalOptions& global, int& result);

} // namespace fathom
