// SPDX-License-Identifier: Apache-2.0
// `fathom register SCENE.yaml`: where the camera is in the base frame, from tags that it sees or from points.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

void addRegisterCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
