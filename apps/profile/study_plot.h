// SPDX-License-Identifier: Apache-2.0
// The plot of a study: its panels in one row or two, points labelled by setting, the default ringed, the
// Pareto front as a line.
#pragma once

#include "apps/output/image.h"
#include "apps/profile/study.h"

namespace fathom::profile {

// subtitle: one line under the title with the device and what was verified.
Image studyPlot(const Study& study, const std::string& subtitle);

// Arrangement of the panels, row by row in one row or two.
struct PanelGrid {
    int across, down;
};
PanelGrid panelGrid(size_t panels);

// The axis of a panel, linear or logarithmic. A logarithmic axis shows values <= 0 at its low end.
struct PanelAxis {
    bool log = false, hasZero = false;
    double linear = 0.0;       // signed logarithmic axis: roughly linear up to here; 0 = other axis
    double lo = 0.0, hi = 1.0; // range of the data, in decades when log
    double from = 0.0, to = 1.0;

    double at(double value) const;
    struct Tick {
        double value;
        std::string label;
    };
    std::vector<Tick> ticks() const;
};
PanelAxis panelAxis(const std::vector<double>& values, bool log, double from, double to);
// Axis that is logarithmic in both directions from 0, over three decades.
PanelAxis signedLogAxis(const std::vector<double>& values, double from, double to);

} // namespace fathom::profile
