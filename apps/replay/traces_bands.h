// SPDX-License-Identifier: Apache-2.0
// What lies behind the traces of traces.png: shaded bands, the strip of lettered phases, the frame ticks, the
// legend.
#pragma once

#include "apps/replay/image.h"
#include "apps/replay/plot_axis.h"
#include "apps/replay/trace_history.h"

#include <string>

namespace fathom::traces {

struct Panel {
    double top, bottom; // [pixels]
};

// Which kinds of band a run has, so that the legend names those alone.
struct BandsSeen {
    bool contact = false, guidance = false, alarm = false, idle = false;
};

BandsSeen drawBands(const Image& image, const TraceHistory& history, const PlotAxis& time,
                    const Panel& panel);
void drawPhaseStrip(const Image& image, const TraceHistory& history, const PlotAxis& time);
// Ticks at the panel's foot where a new frame came into force; none when they would run together (returns
// false).
bool drawFrameTicks(const Image& image, const TraceHistory& history, const PlotAxis& time,
                    const Panel& panel);
void drawLegend(const Image& image, const BandsSeen& seen, bool frameTicks, bool limits,
                const std::string& remark);
// The line of a limit.
void dashedLine(const Image& image, double from, double to, double y);
// Diagonal lines over a rectangle, for what must not be told by colour alone.
void hatch(const Image& image, double x, double y, double width, double height, Colour colour);

} // namespace fathom::traces
