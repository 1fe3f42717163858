// SPDX-License-Identifier: Apache-2.0
// traces.png: force norm over torque norm against time, as the paper's Figs. 4 and 5, with the phases
// lettered.
#pragma once

#include "apps/replay/trace_history.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

struct TracesLabels {
    std::string title = "Force and torque on the hand";
    std::string subtitle;              // scene, device, rate
    std::optional<double> forceLimit;  // [N]
    std::optional<double> torqueLimit; // [N m]
};

// 1600 x 1000 pixels, two panels over one time axis [s]. Below the traces: sand where in contact, blue where
// guidance was on, hatched red where escaping or trapped, grey where off or fading. Any run length, an empty
// run too. Throws Error that names the file.
void writeTraces(const std::filesystem::path& file, const TraceHistory& history, const TracesLabels& labels);

} // namespace fathom
