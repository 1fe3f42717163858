// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/panel_painter.h"

#include <algorithm>
#include <cmath>

namespace fathom::profile {

namespace {

bool hasErrorBars(const Study& study) {
    return std::ranges::any_of(study.panels, [](const PlotPanel& panel) {
        return std::ranges::any_of(panel.series, [](const PlotSeries& series) {
            return std::ranges::any_of(series.points, [](const PlotPoint& p) {
                return std::isfinite(p.xHigh) || std::isfinite(p.yHigh);
            });
        });
    });
}

} // namespace

PanelGrid panelGrid(size_t panels) {
    constexpr int kMaxInOneRow = 3; // more are too small to read when the image is fitted to a page
    const int count = std::max(1, static_cast<int>(panels));
    const int down = count > kMaxInOneRow ? 2 : 1;
    return {(count + down - 1) / down, down};
}

Image studyPlot(const Study& study, const std::string& subtitle) {
    const PanelGrid grid = panelGrid(study.panels.size());
    Image image(grid.across * kPanelWidth + 8, kHead + grid.down * kPanelHeight, kPaper);
    image.text(24.0, 34.0, study.title, 21, kInk, Align::Left, true);
    image.text(24.0, 60.0,
               subtitle + (study.labels.empty() ? "" : " · " + study.labels) +
                   (hasErrorBars(study) ? " · points are p50, error bars end at p90" : ""),
               13, kFaint);
    const ColourTable colours = coloursOf(study.panels);
    for (size_t i = 0; i < study.panels.size(); ++i) {
        const int k = static_cast<int>(i), row = k / grid.across;
        paintPanel(image, study.panels[i], colours, (k % grid.across) * kPanelWidth,
                   kHead + row * kPanelHeight);
    }
    return image;
}

} // namespace fathom::profile
