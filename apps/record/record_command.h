// SPDX-License-Identifier: Apache-2.0
// `fathom record SCENE.yaml --out DIR`: records the scene's camera for `replay`.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

// result: exit code; 1 when a live camera lost frames.
void addRecordCommand(CLI::App& app, int& result);

} // namespace fathom
