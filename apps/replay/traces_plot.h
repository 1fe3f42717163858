// SPDX-License-Identifier: Apache-2.0
// Draws traces.png: the norms of force and torque over time with lettered phases, like Figs. 4 and 5 of the
// paper.
#pragma once

#include "apps/output/image.h"
#include "apps/replay/trace_history.h"

#include <optional>
#include <string>

namespace fathom {

struct TracesLabels {
    std::string title = "Force and torque on the hand";
    std::string subtitle;              // scene, device, rate
    std::optional<double> forceLimit;  // [N]
    std::optional<double> torqueLimit; // [N m]
};

// 1600 x 1000 pixels, two panels with one time axis [s]. The background is sand in contact, blue with
// guidance, hatched red when escaping or trapped (a few ticks: a mark at the axis), grey when off or fading.
// Accepts runs of any length, also empty ones.
Image drawTraces(const TraceHistory& history, const TracesLabels& labels);

} // namespace fathom
