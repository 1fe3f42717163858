// SPDX-License-Identifier: Apache-2.0
// `fathom register SCENE.yaml`: estimates the camera's pose in the base frame from visible tags, a chessboard
// or points.
#pragma once

#include "apps/global_options.h"

namespace CLI {
class App;
}

namespace fathom {

void addRegisterCommand(CLI::App& app, const GlobalOptions& global);

} // namespace fathom
