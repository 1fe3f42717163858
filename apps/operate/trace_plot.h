// SPDX-License-Identifier: Apache-2.0
// Force or torque over ten seconds with a fixed scale, its figures, and the lane of events.
#pragma once

#include "apps/operate/trace_columns.h"
#include "apps/operate/wrench_figures.h"

namespace fathom::operate {

// Colours of the base axes in the traces.
inline constexpr ImU32 kAxisColours[] = {IM_COL32(255, 120, 110, 190), IM_COL32(110, 220, 130, 190),
                                         IM_COL32(110, 160, 255, 190)};

// Window pixels of the curves: right of the numbers of the scale, left of the figures.
struct TraceArea {
    ImVec2 at, size;
    double from = 0.0, to = 0.0; // [s]
    float x(double t) const { return at.x + size.x * static_cast<float>((t - from) / (to - from)); }
};

// The columns left and right of the curves [pixels], in the present font.
float scaleColumn();
float figuresColumn();

// Delivered: three axes and, bold, the size; dashed: the size of the residual. The scale ends at the limit.
// columns: as many as the area has pixels in a row.
void drawTracePlot(const WrenchFigures& plot, const TraceArea& area, const TraceColumns& columns);
// A state that has a name, or guidance, from its begin to its end.
struct TraceSpan {
    double from = 0.0, to = 0.0; // [s]
    const char* word = "";
    ImU32 colour = 0;
};
// Guidance first, then states, each in order of time. Spans of one word less than 0.1 s apart are one.
std::vector<TraceSpan> traceSpans(const std::deque<TraceSample>& trace);
// What happened, below the curves: new fixture sets, late ticks, guidance and states as bars with their
// names.
void drawEvents(const TraceArea& lane, const std::deque<TraceSample>& trace);

} // namespace fathom::operate
