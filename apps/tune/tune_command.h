// SPDX-License-Identifier: Apache-2.0
// `fathom tune SCENE`: chooses settings of a scene from measured points of error against time.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

// result: exit code, 1 when no point meets the request.
void addTuneCommand(CLI::App& app, const GlobalOptions& global, int& result);

} // namespace fathom
