// SPDX-License-Identifier: Apache-2.0
// The background of traces.png: shaded bands, the strip of lettered phases, frame ticks, the legend.
#pragma once

#include "apps/output/image.h"
#include "apps/output/plot_axis.h"
#include "apps/replay/trace_history.h"

#include <string>

namespace fathom::traces {

struct Panel {
    double top, bottom; // [pixels] in y
};

// What occurs in a run; the legend lists only this.
struct BandsSeen {
    bool contact = false, guidance = false, alarm = false;
    bool brief = false; // an alarm of a few ticks
    bool idle = false;
    bool residual = false; // of the wrench, not a band
};

BandsSeen drawBands(const Image& image, const TraceHistory& history, const PlotAxis& time,
                    const Panel& panel);
void drawPhaseStrip(const Image& image, const TraceHistory& history, const PlotAxis& time);
// Draws ticks at the bottom of the panel where a new frame became active. Draws none and returns false if
// they would merge.
bool drawFrameTicks(const Image& image, const TraceHistory& history, const PlotAxis& time,
                    const Panel& panel);
void drawLegend(const Image& image, const BandsSeen& seen, bool frameTicks, bool limits,
                const std::string& remark);
void dashedLine(const Image& image, double from, double to, double y);
// Draws diagonal lines over a rectangle, so that its meaning does not depend on colour alone.
void hatch(const Image& image, double x, double y, double width, double height, Colour colour);

} // namespace fathom::traces
