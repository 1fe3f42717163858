// SPDX-License-Identifier: Apache-2.0
// `fathom latency SCENE`: measures how reliably this machine runs the haptic thread.
#pragma once

#include "apps/latency/latency_run.h"

namespace CLI {
class App;
}

namespace fathom {

// result: exit code, 1 when a soak test misses its limits. windowLoad: measures the load `window`.
void addLatencyCommand(CLI::App& app, const GlobalOptions& global, WindowLoad windowLoad, int& result);

} // namespace fathom
