// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/panel_frame.h"

#include "apps/profile/panel_colours.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fathom::profile {

namespace {

// Width of the legend, which is to the right of the plot and never covers data.
double legendRoom(const Image& image, const PlotPanel& panel) {
    double widest = 0.0;
    for (const PlotSeries& s : panel.series) {
        widest = std::max(widest, image.textWidth(s.name, 13));
    }
    return panel.bars ? 0.0 : widest + 40.0;
}

double labelRoom(const Image& image, const PlotPanel& panel) {
    double widest = 60.0;
    for (const PlotSeries& s : panel.series) {
        for (const PlotPoint& q : s.points) {
            widest = std::max(widest, image.textWidth(q.label, 13, q.isDefault));
        }
    }
    return widest + 32.0;
}

} // namespace

PanelFrame::PanelFrame(const Image& image, const PlotPanel& panel, double left, double top)
    : p_(image)
    , panel_(panel)
    , box_{left + (panel.bars ? labelRoom(image, panel) : 86.0), top + 40.0,
           left + kPanelWidth - 24.0 - legendRoom(image, panel), top + kPanelHeight - 62.0} {
    std::vector<double> xs, ys;
    for (const PlotSeries& s : panel.series) {
        for (const PlotPoint& q : s.points) {
            xs.push_back(q.x);
            ys.push_back(q.y);
            if (std::isfinite(q.xHigh)) {
                xs.push_back(q.xHigh);
            }
            if (std::isfinite(q.yHigh)) {
                ys.push_back(q.yHigh);
            }
        }
    }
    if (panel.bars && panel.logX) {
        xs.push_back(kBarFoot);
    }
    x_ = panel.signedLog ? signedLogAxis(xs, box_.x0, box_.x1) : panelAxis(xs, panel.logX, box_.x0, box_.x1);
    y_ = panelAxis(ys, panel.logY, box_.y1, box_.y0);
}

void PanelFrame::line(double x0, double y0, double x1, double y1, Colour colour, double width) const {
    p_.setColour(colour);
    cairo_set_line_width(p_.cr(), width);
    cairo_move_to(p_.cr(), x0, y0);
    cairo_line_to(p_.cr(), x1, y1);
    cairo_stroke(p_.cr());
}

void PanelFrame::errorBar(double x0, double y0, double x1, double y1, Colour colour) const {
    const double across = x0 == x1 ? 4.0 : 0.0, along = 4.0 - across;
    line(x0, y0, x1, y1, colour, 1.4);
    line(x1 - across, y1 - along, x1 + across, y1 + along, colour, 1.4);
}

void PanelFrame::paintXAxis() const {
    for (const PanelAxis::Tick& t : x_.ticks()) {
        const double x = x_.at(t.value);
        line(x, box_.y0, x, box_.y1, kGrid, 1.0);
        p_.text(x, box_.y1 + 20.0, t.label, 13, kInk, Align::Centre);
    }
    line(box_.x0, box_.y1, box_.x1, box_.y1, kInk, 1.2);
    p_.text(0.5 * (box_.x0 + box_.x1), box_.y1 + 44.0, panel_.xLabel, 14, kInk, Align::Centre);
}

void PanelFrame::paintAxes() const {
    for (const PanelAxis::Tick& t : y_.ticks()) {
        const double y = y_.at(t.value);
        line(box_.x0, y, box_.x1, y, kGrid, 1.0);
        p_.text(box_.x0 - 8.0, y + 5.0, t.label, 13, kInk, Align::Right);
    }
    paintXAxis();
    line(box_.x0, box_.y0, box_.x0, box_.y1, kInk, 1.2);
    cairo_save(p_.cr());
    cairo_translate(p_.cr(), box_.x0 - 64.0, 0.5 * (box_.y0 + box_.y1));
    cairo_rotate(p_.cr(), -0.25 * kTurn);
    p_.text(0.0, 0.0, panel_.yLabel, 14, kInk, Align::Centre);
    cairo_restore(p_.cr());
}

} // namespace fathom::profile
