// SPDX-License-Identifier: Apache-2.0
// The load `window` of `fathom latency`.
#pragma once

#include "apps/latency/latency_run.h"

namespace fathom::operate {

// Runs the operator's window, or draws offscreen where there is no display.
LatencyPart measureWindow(const LatencyOptions& options, const GlobalOptions& global);

} // namespace fathom::operate
