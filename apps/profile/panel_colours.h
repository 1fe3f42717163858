// SPDX-License-Identifier: Apache-2.0
// Sizes and colours of a study's plot. A thing has the same colour in all panels.
#pragma once

#include "apps/profile/study_plot.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace fathom::profile {

inline constexpr int kPanelWidth = 780, kPanelHeight = 560, kHead = 84;
inline constexpr double kBarFoot = 1.0; // start of bars on a logarithmic axis: a ratio of 1
inline constexpr Colour kPaper{0.992, 0.992, 0.988}, kInk{0.13, 0.15, 0.18}, kFaint{0.45, 0.48, 0.52},
    kGrid{0.88, 0.89, 0.9};
// Colour-blind safe palette (Okabe and Ito).
inline constexpr std::array<Colour, 11> kSeries{{{0.0, 0.45, 0.70},
                                                 {0.84, 0.37, 0.0},
                                                 {0.0, 0.62, 0.45},
                                                 {0.80, 0.47, 0.65},
                                                 {0.90, 0.62, 0.0},
                                                 {0.34, 0.71, 0.91},
                                                 {0.35, 0.35, 0.35},
                                                 {0.55, 0.34, 0.16},
                                                 {0.0, 0.0, 0.0},
                                                 {0.53, 0.56, 0.0},
                                                 {0.43, 0.27, 0.67}}};

// Maps a thing to its palette index, the same in all panels of a study.
using ColourTable = std::map<std::string, size_t>;
inline const std::string& thingOf(const PlotSeries& series) {
    return series.thing.empty() ? series.name : series.thing;
}
inline ColourTable coloursOf(const std::vector<PlotPanel>& panels) {
    ColourTable colours;
    for (const PlotPanel& panel : panels) {
        for (const PlotSeries& series : panel.series) {
            colours.emplace(thingOf(series), colours.size());
        }
    }
    return colours;
}

} // namespace fathom::profile
