// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/stability_plots.h"

#include "apps/output/curve_plot.h"
#include "apps/output/image.h"
#include "apps/output/plot_axis.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr Colour kPaper{1.0, 1.0, 1.0}, kInk{0.10, 0.14, 0.19}, kQuiet{0.39, 0.43, 0.48},
    kGrid{0.885, 0.895, 0.91};
constexpr Colour kBar{0.16, 0.42, 0.80}, kBroken{0.76, 0.16, 0.13};
constexpr double kRow = 17.0, kTop = 104.0, kLeft = 330.0, kRight = 1010.0;
constexpr int kWidth = 1240;
constexpr double kAxisBegin = -9.0, kAxisEnd = 1.0; // axis range: log10(figure / limit)

// 0 = far within the limit, 1 = at the limit; everything beyond the axis returns 10.
double shareOfLimit(const Outcome& o) {
    if (!std::isfinite(o.figure)) {
        return 10.0;
    }
    const bool least = o.relation == ">=";
    const double part = least ? o.limit : o.figure, whole = least ? o.figure : o.limit;
    if (part <= 0.0) {
        return o.holds() ? 0.0 : 10.0;
    }
    return whole > 0.0 ? part / whole : 10.0;
}

void drawAxis(const fathom::Image& image, const PlotAxis& axis, double bottom) {
    for (int decade = static_cast<int>(kAxisBegin); decade <= static_cast<int>(kAxisEnd); ++decade) {
        const double x = axis.at(decade);
        image.setColour(decade == 0 ? kBroken : kGrid);
        cairo_set_line_width(image.cr(), decade == 0 ? 2.0 : 1.0);
        cairo_move_to(image.cr(), x, kTop - 6.0);
        cairo_line_to(image.cr(), x, bottom);
        cairo_stroke(image.cr());
        image.text(x, kTop - 12.0, decade == 0 ? "limit" : roundNumber(std::pow(10.0, decade)), 12.0, kQuiet,
                   Align::Centre);
    }
}

void drawBar(const fathom::Image& image, const PlotAxis& axis, double y, const CaseResult& r) {
    const double share = shareOfLimit(r.outcome);
    const double end =
        axis.at(std::clamp(share > 0.0 ? std::log10(share) : kAxisBegin, kAxisBegin + 0.03, kAxisEnd));
    image.setColour(r.outcome.holds() ? kBar : kBroken);
    cairo_rectangle(image.cr(), axis.from, y - 10.0, end - axis.from, 11.0);
    cairo_fill(image.cr());
    image.text(kLeft - 8.0, y, r.name, 12.0, kInk, Align::Right);
    image.text(kRight + 10.0, y, comparison(r.outcome), 12.0, r.outcome.holds() ? kQuiet : kBroken);
}

void writeMargins(const std::filesystem::path& file, const std::vector<CaseResult>& results) {
    size_t groups = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        groups += i == 0 || results[i].group != results[i - 1].group ? 1 : 0;
    }
    const double height =
        kTop + kRow * (static_cast<double>(results.size()) + 1.6 * static_cast<double>(groups)) + 30.0;
    const fathom::Image image(kWidth, static_cast<int>(height), kPaper);
    const PlotAxis axis{kAxisBegin, kAxisEnd, kLeft, kRight};
    image.text(24.0, 36.0, "Stability suite: share of its limit that each case uses", 20.0, kInk, Align::Left,
               true);
    image.text(24.0, 60.0,
               "figure / limit (limit / figure where the figure must be large), pure number; figure and "
               "limit at the right",
               13.0, kQuiet);
    drawAxis(image, axis, height - 20.0);
    double y = kTop;
    for (size_t i = 0; i < results.size(); ++i) {
        if (i == 0 || results[i].group != results[i - 1].group) {
            y += 1.6 * kRow;
            image.text(24.0, y - 2.0, kGroupNames[static_cast<size_t>(results[i].group)], 14.0, kInk,
                       Align::Left, true);
        }
        y += kRow;
        drawBar(image, axis, y, results[i]);
    }
    image.writePng(file);
}

bool sameAxes(const Outcome::Curve& a, const Outcome::Curve& b) {
    return a.xLabel == b.xLabel && a.yLabel == b.yLabel && a.logX == b.logX && a.logY == b.logY;
}

void writeCurves(const std::filesystem::path& folder, const CaseResult& r) {
    std::vector<bool> drawn(r.outcome.curves.size(), false);
    int plots = 0;
    for (size_t i = 0; i < drawn.size(); ++i) {
        std::vector<Outcome::Curve> together;
        for (size_t k = i; k < drawn.size(); ++k) {
            if (!drawn[k] && sameAxes(r.outcome.curves[i], r.outcome.curves[k])) {
                together.push_back(r.outcome.curves[k]);
                drawn[k] = true;
            }
        }
        if (!together.empty()) {
            std::string name = r.name;
            if (++plots > 1) {
                name.append("-").append(std::to_string(plots));
            }
            writeCurvePlot(folder / name.append(".png"), r.name, comparison(r.outcome), together);
        }
    }
}

} // namespace

void writePlots(const std::filesystem::path& folder, const std::vector<CaseResult>& results) {
    if (!results.empty()) {
        writeMargins(folder / "margins.png", results);
    }
    for (const CaseResult& r : results) {
        writeCurves(folder, r);
    }
}

} // namespace fathom::stability
