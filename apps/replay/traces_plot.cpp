// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/traces_plot.h"

#include "apps/output/plot_axis.h"
#include "apps/replay/traces_bands.h"
#include "apps/replay/traces_style.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

using namespace traces;

constexpr double kFelt = 1e-6; // [N], [N m]; less is rounding error, and no hand feels it

struct Line {
    double TraceBin::*min;
    double TraceBin::*max;
    TraceHistory::Peak peak;

    bool seen() const { return peak.value > kFelt; }
};

struct Series {
    const char* title;
    const char* unit;
    Line delivered, residual;
    std::optional<double> limit;
    Panel panel;
};

// An axis from zero to a round value above the peak. It includes the limit if the trace comes near it.
PlotAxis valueAxis(const Series& series) {
    constexpr double kNear = 0.55;
    const double peak = std::max(series.delivered.peak.value, series.residual.peak.value);
    double top = peak > 0.0 ? 1.12 * peak : 1.0;
    if (series.limit && *series.limit > 0.0 && peak >= kNear * *series.limit) {
        top = std::max(top, 1.12 * *series.limit);
    }
    top = std::max(top, kFelt); // keeps rounding errors from setting the scale
    const double step = roundStep(top, 8);
    return {0.0, step * std::ceil(top / step), series.panel.bottom, series.panel.top};
}

PlotAxis timeAxis(const TraceHistory& history) {
    const auto& bins = history.bins();
    const double begin = bins.empty() ? 0.0 : bins.front().begin;
    double end = bins.empty() ? 1.0 : bins.back().end;
    if (!(end > begin)) {
        end = begin + 1.0; // an empty run, or one of a single tick
    } else {
        end += (end - begin) / static_cast<double>(history.ticks() - 1); // include the last tick's duration
    }
    return {begin, end, kLeft, kRight};
}

void drawFrameAndGrid(const Image& image, const Series& series, const PlotAxis& time, const PlotAxis& value,
                      bool timeLabels) {
    const Panel& panel = series.panel;
    for (const PlotTick& tick : ticksOf(value, 6)) {
        const double y = std::round(value.at(tick.value)) + 0.5;
        image.line(kLeft, y, kRight, y, tick.value == 0.0 ? kQuietInk : kGrid, 1.0);
        image.text(kLeft - 12.0, y + 5.0, tick.label, 15.0, kInk, Align::Right);
    }
    for (const PlotTick& tick : ticksOf(time, 12)) {
        const double x = std::round(time.at(tick.value)) + 0.5;
        image.line(x, panel.top, x, panel.bottom, kGrid, 1.0);
        if (timeLabels) {
            image.text(x, panel.bottom + 24.0, tick.label, 15.0, kInk, Align::Centre);
        }
    }
    image.textUpwards(36.0, 0.5 * (panel.top + panel.bottom),
                      std::string(series.title) + " [" + series.unit + "]", 17.0, kInk, true);
}

// One point per bin, or the extremes of each pixel column when there are more bins than columns. A column
// without a finite value breaks the line.
void traceLine(const Image& image, const TraceHistory& history, const Line& line, Colour colour,
               const PlotAxis& time, const PlotAxis& value) {
    cairo_t* cr = image.cr();
    const auto& bins = history.bins();
    bool drawing = false;
    for (size_t i = 0; i < bins.size();) {
        const double column = std::floor(time.at(bins[i].begin));
        double lo = 0.0, hi = -1.0;
        const double x = time.at(bins[i].begin);
        for (; i < bins.size() && std::floor(time.at(bins[i].begin)) == column; ++i) {
            if (bins[i].*line.max >= bins[i].*line.min) {
                lo = hi < lo ? bins[i].*line.min : std::min(lo, bins[i].*line.min);
                hi = std::max(hi, bins[i].*line.max);
            }
        }
        if (hi < lo) {
            drawing = false;
            continue;
        }
        (drawing ? cairo_line_to : cairo_move_to)(cr, x, value.at(hi));
        cairo_line_to(cr, x, value.at(lo) + 0.01); // draws a single point as a dot
        drawing = true;
    }
    image.setColour(colour);
    cairo_set_line_width(cr, 1.8);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_stroke(cr);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

// Text on a pale background, so that it stays readable over grid and trace.
void label(const Image& image, double x, double y, const std::string& words, Colour colour, Align align) {
    const double width = image.textWidth(words, 14.5);
    const double left = align == Align::Left ? x : align == Align::Right ? x - width : x - 0.5 * width;
    image.box(left - 5.0, y - 14.5, width + 10.0, 20.0, kPaper.alpha(0.82));
    image.text(x, y, words, 14.5, colour, align);
}

// Returns true when the axis reaches the limit; otherwise writes its value in the corner.
bool drawLimit(const Image& image, const Series& series, const PlotAxis& value) {
    if (!series.limit || !std::isfinite(*series.limit)) {
        return false;
    }
    const std::string words = "limit " + roundNumber(*series.limit) + " " + series.unit;
    if (*series.limit > value.hi) {
        label(image, kRight - 12.0, series.panel.top + 22.0, words + ", above this axis", kQuietInk,
              Align::Right);
        return false;
    }
    const double y = std::round(value.at(*series.limit)) + 0.5;
    dashedLine(image, kLeft, kRight, y);
    label(image, kRight - 12.0, y - 8.0, words, kAlarm, Align::Right);
    return true;
}

void drawPeak(const Image& image, const Series& series, const PlotAxis& time, const PlotAxis& value) {
    if (series.delivered.peak.value <= 0.0) {
        label(image, 0.5 * (kLeft + kRight), 0.5 * (series.panel.top + series.panel.bottom),
              "zero throughout", kQuietInk, Align::Centre);
        return;
    }
    const double x = time.at(series.delivered.peak.t), y = value.at(series.delivered.peak.value);
    image.dot(x, y, 5.5, kPaper);
    image.dot(x, y, 3.8, kTrace);
    const bool toLeft = x > 0.5 * (kLeft + kRight);
    label(image, toLeft ? x - 14.0 : x + 14.0, std::max(y - 6.0, series.panel.top + 18.0),
          "peak " + shortNumber(series.delivered.peak.value) + " " + series.unit +
              printed(" at %.3f s", series.delivered.peak.t),
          kInk, toLeft ? Align::Right : Align::Left);
}

std::string remark(const TraceHistory& history) {
    return std::to_string(history.ticks()) + (history.ticks() == 1 ? " tick, " : " ticks, ") +
           std::to_string(history.newFrames()) + (history.newFrames() == 1 ? " frame" : " frames");
}

} // namespace

Image drawTraces(const TraceHistory& history, const TracesLabels& labels) {
    Image image(kWidth, kHeight, kPaper);
    const PlotAxis time = timeAxis(history);
    const Series series[] = {{"Force",
                              "N",
                              {&TraceBin::forceMin, &TraceBin::forceMax, history.forcePeak()},
                              {&TraceBin::restForceMin, &TraceBin::restForceMax, history.restForcePeak()},
                              labels.forceLimit,
                              {kForceTop, kForceBottom}},
                             {"Torque",
                              "N m",
                              {&TraceBin::torqueMin, &TraceBin::torqueMax, history.torquePeak()},
                              {&TraceBin::restTorqueMin, &TraceBin::restTorqueMax, history.restTorquePeak()},
                              labels.torqueLimit,
                              {kTorqueTop, kTorqueBottom}}};
    image.text(kLeft, kTitleBase, labels.title, 28.0, kInk, Align::Left, true);
    image.text(kLeft, kSubtitleBase, labels.subtitle, 16.0, kQuietInk);
    BandsSeen seen;
    bool limits = false, frameTicks = false;
    for (const Series& one : series) {
        seen = drawBands(image, history, time, one.panel);
    }
    drawPhaseStrip(image, history, time);
    for (const Series& one : series) {
        const PlotAxis value = valueAxis(one);
        drawFrameAndGrid(image, one, time, value, &one == &series[1]);
        frameTicks = drawFrameTicks(image, history, time, one.panel) || frameTicks;
        limits = drawLimit(image, one, value) || limits;
        if (one.residual.seen()) {
            traceLine(image, history, one.residual, kResidual, time, value);
            seen.residual = true;
        }
        traceLine(image, history, one.delivered, kTrace, time, value);
        drawPeak(image, one, time, value);
    }
    image.text(0.5 * (kLeft + kRight), kTorqueBottom + 54.0, "time [s]", 17.0, kInk, Align::Centre, true);
    drawLegend(image, seen, frameTicks, limits, remark(history));
    return image;
}

} // namespace fathom
