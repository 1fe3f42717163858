// SPDX-License-Identifier: Apache-2.0
// The plot area of a panel, with its axes.
#pragma once

#include "apps/profile/plot_labels.h"
#include "apps/profile/study_plot.h"

namespace fathom::profile {

// All positions in pixels of the image. Image and panel must outlive it.
class PanelFrame {
public:
    // left, top: of the panel, which is kPanelWidth x kPanelHeight.
    PanelFrame(const Image& image, const PlotPanel& panel, double left, double top);

    const PlotBox& box() const { return box_; } // without title, labels and legend
    double x(double value) const { return x_.at(value); }
    double y(double value) const { return y_.at(value); }

    void paintXAxis() const;
    void paintAxes() const;
    void line(double x0, double y0, double x1, double y1, Colour colour, double width) const;
    // A line from a value to its p90, with a cap at the end.
    void errorBar(double x0, double y0, double x1, double y1, Colour colour) const;

private:
    const Image& p_;
    const PlotPanel& panel_;
    PlotBox box_;
    PanelAxis x_, y_;
};

} // namespace fathom::profile
