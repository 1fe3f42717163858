// SPDX-License-Identifier: Apache-2.0
#include "apps/output/curve_plot.h"

#include "apps/output/image.h"
#include "apps/output/plot_axis.h"
#include "apps/output/plot_colours.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom {

namespace {

constexpr std::array<Colour, 6> kLines{{{0.16, 0.42, 0.80},
                                        {0.80, 0.45, 0.10},
                                        {0.15, 0.55, 0.30},
                                        {0.70, 0.20, 0.45},
                                        {0.35, 0.35, 0.40},
                                        {0.10, 0.60, 0.65}}};
constexpr int kWidth = 960, kHeight = 600;
constexpr double kLeft = 96.0, kRight = 930.0, kTop = 110.0, kBottom = 530.0;

// A linear axis, or a logarithmic one in decades.
struct Scale {
    PlotAxis axis;
    bool log = false;

    bool has(double value) const { return std::isfinite(value) && (!log || value > 0.0); }
    double at(double value) const { return axis.at(log ? std::log10(value) : value); }
    // Whole decades on a logarithmic axis, also 2 and 5 when the range is short.
    std::vector<PlotTick> ticks(int most) const {
        if (!log) {
            return ticksOf(axis, most);
        }
        std::vector<PlotTick> ticks;
        const double range = axis.hi - axis.lo, step = std::max(1.0, std::ceil(range / most));
        for (double decade = std::floor(axis.lo); decade <= axis.hi + 1e-9; decade += step) {
            for (const double part : {1.0, 2.0, 5.0}) {
                const double value = decade + std::log10(part);
                if (value >= axis.lo - 1e-9 && value <= axis.hi + 1e-9 && (part == 1.0 || range < 2.2)) {
                    ticks.push_back({value, roundNumber(std::pow(10.0, value))});
                }
            }
        }
        return ticks;
    }
};

Scale scaleOf(const std::vector<PlotCurve>& curves, bool ofX, double from, double to) {
    Scale scale;
    scale.log = ofX ? curves.front().logX : curves.front().logY;
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (const PlotCurve& c : curves) {
        for (const double value : ofX ? c.x : c.y) {
            if (scale.has(value)) {
                lo = std::min(lo, scale.log ? std::log10(value) : value);
                hi = std::max(hi, scale.log ? std::log10(value) : value);
            }
        }
    }
    if (!(lo <= hi)) {
        lo = 0.0;
        hi = 1.0;
    }
    if (scale.log && hi - lo < 0.5) { // at least a decade, so that some tick has a label
        const double middle = 0.5 * (lo + hi);
        lo = middle - 0.5;
        hi = middle + 0.5;
    }
    // Leave room above and below, avoid an empty range, and start a linear axis of amounts at 0.
    const double range = hi - lo > 1e-12 * std::abs(hi) ? hi - lo : std::max(std::abs(hi), 1e-9);
    const bool fromZero = !scale.log && lo >= 0.0 && lo < 0.5 * hi;
    scale.axis = {fromZero ? 0.0 : lo - (ofX ? 0.0 : 0.05 * range),
                  hi + (ofX && hi > lo ? 0.0 : 0.05 * range), from, to};
    return scale;
}

void drawGrid(const Image& image, const Scale& x, const Scale& y) {
    for (const PlotTick& tick : x.ticks(9)) {
        const double at = x.axis.at(tick.value);
        image.line(at, kTop, at, kBottom, kGrid, 1.0);
        image.text(at, kBottom + 20.0, tick.label, 13.0, kQuietInk, Align::Centre);
    }
    for (const PlotTick& tick : y.ticks(7)) {
        const double at = y.axis.at(tick.value);
        image.line(kLeft, at, kRight, at, kGrid, 1.0);
        image.text(kLeft - 8.0, at + 4.0, tick.label, 13.0, kQuietInk, Align::Right);
    }
}

void drawCurve(const Image& image, const Scale& x, const Scale& y, const PlotCurve& curve, Colour colour) {
    cairo_t* cr = image.cr();
    image.setColour(colour);
    cairo_set_line_width(cr, 2.0);
    const size_t count = std::min(curve.x.size(), curve.y.size());
    bool open = false;
    for (size_t i = 0; i < count; ++i) {
        if (!x.has(curve.x[i]) || !y.has(curve.y[i])) {
            open = false;
            continue;
        }
        (open ? cairo_line_to : cairo_move_to)(cr, x.at(curve.x[i]), y.at(curve.y[i]));
        open = true;
    }
    cairo_stroke(cr);
    for (size_t i = 0; i < count && count <= 60; ++i) {
        if (x.has(curve.x[i]) && y.has(curve.y[i])) {
            image.dot(x.at(curve.x[i]), y.at(curve.y[i]), 3.5, colour);
        }
    }
}

void drawLegend(const Image& image, const std::vector<PlotCurve>& curves) {
    double left = kLeft;
    for (size_t i = 0; i < curves.size(); ++i) {
        image.box(left, 84.0, 18.0, 4.0, kLines[i % kLines.size()]);
        image.text(left + 24.0, 91.0, curves[i].name, 13.0, kInk);
        left += 44.0 + image.textWidth(curves[i].name, 13.0);
    }
}

} // namespace

void writeCurvePlot(const std::filesystem::path& file, const std::string& title, const std::string& subtitle,
                    const std::vector<PlotCurve>& curves) {
    const Image image(kWidth, kHeight, kPaper);
    const Scale x = scaleOf(curves, true, kLeft, kRight), y = scaleOf(curves, false, kBottom, kTop);
    image.text(24.0, 36.0, title, 20.0, kInk, Align::Left, true);
    image.text(24.0, 60.0, subtitle, 13.0, kQuietInk);
    drawGrid(image, x, y);
    for (size_t i = 0; i < curves.size(); ++i) {
        drawCurve(image, x, y, curves[i], kLines[i % kLines.size()]);
    }
    drawLegend(image, curves);
    image.text(0.5 * (kLeft + kRight), kBottom + 52.0, curves.front().xLabel, 15.0, kInk, Align::Centre);
    image.textUpwards(26.0, 0.5 * (kTop + kBottom), curves.front().yLabel, 15.0, kInk);
    image.writePng(file);
}

} // namespace fathom
