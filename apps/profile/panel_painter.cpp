// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/panel_painter.h"

#include "apps/profile/panel_frame.h"
#include "engine/types/angle.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fathom::profile {

namespace {

constexpr size_t kMaxLabels = 24; // of points in a panel that all have a label

// Draws one panel into its rectangle of the image.
class PanelPainter {
public:
    PanelPainter(const Image& image, const PlotPanel& panel, const ColourTable& colours, double left,
                 double top)
        : p_(image)
        , panel_(panel)
        , colours_(colours)
        , frame_(image, panel, left, top)
        , box_(frame_.box()) {}

    void paint() {
        p_.text(box_.x0, box_.y0 - 16.0, panel_.title, 16, kInk, Align::Left, true);
        if (panel_.bars) {
            paintBars();
            return;
        }
        frame_.paintAxes();
        for (size_t i = 0; i < panel_.series.size(); ++i) {
            paintLine(panel_.series[i], colourOf(i));
        }
        for (size_t i = 0; i < panel_.series.size(); ++i) {
            paintPoints(panel_.series[i], colourOf(i));
        }
        paintLegend();
        paintLabels();
    }

private:
    Colour colourOf(size_t i) const {
        return kSeries[colours_.at(thingOf(panel_.series[i])) % kSeries.size()];
    }

    void setDash(double dash) const { cairo_set_dash(p_.cr(), &dash, dash > 0.0 ? 1 : 0, 0.0); }

    // Text on a background box, so that it stays readable over lines.
    void words(double x, double y, const std::string& text, Colour colour, bool bold) const {
        for (const double dx : {-1.5, 0.0, 1.5}) {
            for (const double dy : {-1.5, 0.0, 1.5}) {
                p_.text(x + dx, y + dy, text, 12, kPaper, Align::Left, bold);
            }
        }
        p_.text(x, y, text, 12, colour, Align::Left, bold);
    }

    void dot(double x, double y, double radius, Colour colour, bool filled) const {
        p_.setColour(colour);
        cairo_arc(p_.cr(), x, y, radius, 0, kTurn);
        cairo_set_line_width(p_.cr(), 2.0);
        filled ? cairo_fill(p_.cr()) : cairo_stroke(p_.cr());
    }

    // Corners of a line in the order of the points, or of the front as steps, because nothing between two
    // settings was measured. [pixels]
    std::vector<glm::dvec2> lineOf(const PlotSeries& series) const {
        std::vector<PlotPoint> points = series.points;
        if (!series.connect) {
            std::erase_if(points, [](const PlotPoint& q) { return !q.isFront; });
            std::ranges::sort(points, {}, &PlotPoint::x);
        }
        std::vector<glm::dvec2> corners;
        for (const PlotPoint& q : points) {
            const glm::dvec2 corner(frame_.x(q.x), frame_.y(q.y));
            if (!series.connect && !corners.empty()) {
                corners.emplace_back(corner.x, corners.back().y);
            }
            corners.push_back(corner);
        }
        return corners;
    }

    void paintLine(const PlotSeries& series, Colour colour) const {
        p_.setColour(colour.alpha(series.connect ? 0.9 : 0.55));
        cairo_set_line_width(p_.cr(), series.connect ? 2.2 : 3.0);
        setDash(series.dash);
        for (const glm::dvec2& corner : lineOf(series)) {
            cairo_line_to(p_.cr(), corner.x, corner.y);
        }
        cairo_stroke(p_.cr());
        setDash(0.0);
    }

    void paintPoints(const PlotSeries& series, Colour colour) const {
        for (const PlotPoint& q : series.points) {
            const double x = frame_.x(q.x), y = frame_.y(q.y);
            if (std::isfinite(q.xHigh)) {
                frame_.errorBar(x, y, frame_.x(q.xHigh), y, colour.alpha(0.5));
            }
            if (std::isfinite(q.yHigh)) {
                frame_.errorBar(x, y, x, frame_.y(q.yHigh), colour.alpha(0.5));
            }
            dot(x, y, series.connect ? 4.0 : 5.0, q.isFront || series.connect ? colour : colour.alpha(0.45),
                true);
            if (q.isDefault) {
                dot(x, y, 10.0, kInk, false);
            }
        }
    }

    // What no label may cover: the points and the lines.
    std::vector<PlotBox> obstacles() const {
        std::vector<PlotBox> taken;
        for (const PlotSeries& s : panel_.series) {
            for (const PlotPoint& q : s.points) {
                const double r = q.isDefault ? 10.0 : 4.0, x = frame_.x(q.x), y = frame_.y(q.y);
                taken.push_back({x - r, y - r, x + r, y + r});
            }
            const std::vector<glm::dvec2> corners = lineOf(s);
            for (size_t i = 1; i < corners.size(); ++i) {
                addLine(corners[i - 1], corners[i], taken);
            }
        }
        return taken;
    }

    // Points on the front and defaults get their label places first. Where there are many points, the others
    // have no label: the table names them.
    void paintLabels() const {
        std::vector<LabelRequest> all, requests;
        std::vector<const PlotPoint*> points;
        for (const PlotSeries& s : panel_.series) {
            for (const PlotPoint& q : s.points) {
                if (!q.label.empty()) {
                    points.push_back(&q);
                }
            }
        }
        if (points.size() > kMaxLabels) {
            std::erase_if(points, [](const PlotPoint* q) { return !q->isFront && !q->isDefault; });
        }
        std::ranges::stable_sort(points, [](const PlotPoint* a, const PlotPoint* b) {
            return std::pair(!a->isDefault, !a->isFront) < std::pair(!b->isDefault, !b->isFront);
        });
        for (const PlotPoint* q : points) {
            const std::string text = textOf(*q);
            all.push_back({frame_.x(q->x), frame_.y(q->y), p_.textWidth(text, 12, q->isDefault), text});
        }
        const std::vector<size_t> distinct = distinctLabels(all);
        for (const size_t i : distinct) {
            requests.push_back(all[i]);
        }
        const auto places =
            placeLabels(requests, {box_.x0, box_.y0 - 12.0, box_.x1 + 14.0, box_.y1}, obstacles());
        for (size_t i = 0; i < distinct.size(); ++i) {
            paintLabel(*points[distinct[i]], requests[i], places[i]);
        }
    }

    std::string textOf(const PlotPoint& q) const {
        return q.isDefault && q.label != panel_.ringed ? q.label + " (" + panel_.ringed + ")" : q.label;
    }

    void paintLabel(const PlotPoint& q, const LabelRequest& request, const LabelPlace& place) const {
        if (!place.beside) { // line to the nearer end of the text
            const bool right = place.x >= request.x;
            frame_.line(request.x, request.y, right ? place.x - 2.0 : place.box.x1 + 2.0, place.y - 4.0,
                        kFaint.alpha(0.8), 0.9);
        }
        const Colour colour = q.isFront || q.isDefault ? kInk : kFaint;
        words(place.x, place.y, request.text, colour, q.isDefault);
    }

    void paintLegend() const {
        double y = box_.y0 + 10.0;
        for (size_t i = 0; i < panel_.series.size(); ++i, y += 20.0) {
            if (panel_.series[i].dash > 0.0) {
                setDash(panel_.series[i].dash);
                frame_.line(box_.x1 + 6.0, y - 4.0, box_.x1 + 33.0, y - 4.0, colourOf(i), 2.2);
                setDash(0.0);
            } else {
                dot(box_.x1 + 20.0, y - 4.0, 5.0, colourOf(i), true);
            }
            p_.text(box_.x1 + 37.0, y, panel_.series[i].name, 13, kInk);
        }
    }

    // Uses whole numbers where three digits would need an exponent.
    static std::string barFigure(double value) {
        return value >= 1e3 && value < 1e6 ? digits(std::round(value), 6) : digits(value);
    }

    void paintBars() const {
        frame_.paintXAxis();
        size_t count = 0, k = 0;
        for (const PlotSeries& s : panel_.series) {
            count += s.points.size();
        }
        const double step = (box_.y1 - box_.y0 - 8.0) / static_cast<double>(std::max<size_t>(1, count));
        for (size_t i = 0; i < panel_.series.size(); ++i) {
            for (const PlotPoint& q : panel_.series[i].points) {
                const double y = box_.y0 + 4.0 + step * static_cast<double>(k++),
                             foot = frame_.x(panel_.logX ? kBarFoot : 0.0), end = frame_.x(q.x);
                p_.setColour(colourOf(i));
                cairo_rectangle(p_.cr(), std::min(foot, end), y, std::abs(end - foot),
                                std::min(0.72 * step, 30.0));
                cairo_fill(p_.cr());
                const double base = y + 0.5 * std::min(0.72 * step, 30.0) + 5.0;
                p_.text(box_.x0 - 8.0, base, q.label, 13, kInk, Align::Right, q.isDefault);
                double right = std::max(foot, end);
                if (std::isfinite(q.xHigh)) {
                    frame_.errorBar(end, base - 5.0, frame_.x(q.xHigh), base - 5.0, kInk.alpha(0.6));
                    right = std::max(right, frame_.x(q.xHigh));
                }
                const bool inside = right > box_.x1 - 60.0;
                p_.text(inside ? end - 5.0 : right + 5.0, base, barFigure(q.x), 12, inside ? kPaper : kInk,
                        inside ? Align::Right : Align::Left);
            }
        }
    }

    const Image& p_;
    const PlotPanel& panel_;
    const ColourTable& colours_;
    PanelFrame frame_;
    const PlotBox& box_;
};

} // namespace

void paintPanel(const Image& image, const PlotPanel& panel, const ColourTable& colours, double left,
                double top) {
    PanelPainter(image, panel, colours, left, top).paint();
}

} // namespace fathom::profile
