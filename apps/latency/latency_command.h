// SPDX-License-Identifier: Apache-2.0
// `fathom latency SCENE`: what this machine gives the haptic thread.
#pragma once

#include "apps/latency/latency_run.h"

namespace CLI {
class App;
}

namespace fathom {

// result: 1 when a soak's stated limits do not hold.
// windowLoad: measures the load `window`.
void addLatencyCommand(CLI::App& app, const GlobalOptions& global, WindowLoad windowLoad, int& result);

} // namespace fathom
