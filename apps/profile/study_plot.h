// SPDX-License-Identifier: Apache-2.0
// The image of a study: its panels in one row or two, points labelled by their settings, the default
// ringed, the Pareto front as a line.
#pragma once

#include "apps/profile/study.h"
#include "apps/replay/image.h"

namespace fathom::profile {

// subtitle: device and what was verified, one line under the title. Throws Error that names the file.
void writeStudyPlot(const Study& study, const std::string& subtitle, const std::filesystem::path& file);

// How panels stand in a image: row by row, in one row or in two.
struct PanelGrid {
    int across, down;
};
PanelGrid panelGrid(size_t panels);

// The axis of a panel: linear or logarithmic; on a logarithmic one values <= 0 stand at the low end.
struct PanelAxis {
    bool log = false, hasZero = false;
    double linear = 0.0;       // signed logarithmic axis: about linear up to here; 0 = another axis
    double lo = 0.0, hi = 1.0; // of the data, decades when log
    double from = 0.0, to = 1.0;

    double at(double value) const;
    struct Tick {
        double value;
        std::string label;
    };
    std::vector<Tick> ticks() const;
};
PanelAxis panelAxis(const std::vector<double>& values, bool log, double from, double to);
// Logarithmic in both directions from 0; three decades.
PanelAxis signedLogAxis(const std::vector<double>& values, double from, double to);

} // namespace fathom::profile
