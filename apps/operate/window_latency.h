// SPDX-License-Identifier: Apache-2.0
// The load `window` of `fathom latency`.
#pragma once

#include "apps/latency/latency_run.h"

namespace fathom::operate {

// A run in the operator's window, or offscreen where there is no display.
LatencyPart measureWindow(const LatencyOptions& options, const GlobalOptions& global);

} // namespace fathom::operate
