// SPDX-License-Identifier: Apache-2.0
#include "apps/output/plot_axis.h"
#include "apps/profile/study_plot.h"

#include <algorithm>
#include <cmath>

namespace fathom::profile {

namespace {

// At most four digits; thousands and millions as k and M.
std::string tickLabel(double value) {
    return value >= 1e6   ? roundNumber(value * 1e-6) + " M"
           : value >= 1e4 ? roundNumber(value * 1e-3) + " k"
                          : roundNumber(value);
}

constexpr double kZeroRoom = 0.35; // decades below the smallest positive value, for zeros

PanelAxis logAxis(const std::vector<double>& values) {
    PanelAxis axis;
    axis.log = true;
    double least = HUGE_VAL, most = 0.0;
    for (double v : values) {
        axis.hasZero = axis.hasZero || !(v > 0.0);
        least = v > 0.0 ? std::min(least, v) : least;
        most = std::max(most, v);
    }
    if (!(most > 0.0)) {
        least = most = 1.0;
    }
    const double margin = std::max(0.08, 0.06 * std::log10(most / least));
    axis.lo = std::log10(least) - margin - (axis.hasZero ? kZeroRoom : 0.0);
    axis.hi = std::log10(most) + margin;
    return axis;
}

PanelAxis linearAxis(const std::vector<double>& values) {
    PanelAxis axis;
    double most = 0.0, least = 0.0;
    for (double v : values) {
        most = std::max(most, v);
        least = std::min(least, v);
    }
    axis.lo = least < 0.0 ? least - 0.06 * (most - least) : 0.0;
    axis.hi = most > least ? most + 0.06 * (most - least) : least + 1.0;
    return axis;
}

double signedLog(double value, double linear) {
    return std::copysign(std::log10(1.0 + std::abs(value) / linear), value);
}

// Tick positions within a decade, dense enough that even a short axis has some.
std::vector<double> factorsOf(double span) {
    if (span < 0.5) {
        return {1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0};
    }
    return {1.0, 2.0, 5.0};
}

} // namespace

PanelAxis signedLogAxis(const std::vector<double>& values, double from, double to) {
    PanelAxis axis;
    double most = 0.0;
    for (const double v : values) {
        most = std::max(most, std::abs(v));
    }
    axis.from = from;
    axis.to = to;
    axis.linear = std::pow(10.0, std::floor(std::log10(most > 0.0 ? most : 1.0)) - 2.0);
    for (const double v : values) {
        axis.lo = std::min(axis.lo, 1.1 * signedLog(v, axis.linear));
        axis.hi = std::max(axis.hi, 1.1 * signedLog(v, axis.linear));
    }
    return axis;
}

double PanelAxis::at(double value) const {
    const double v = linear > 0.0  ? signedLog(value, linear)
                     : !log        ? value
                     : value > 0.0 ? std::log10(value)
                                   : lo + 0.3 * kZeroRoom;
    return from + (v - lo) / (hi - lo) * (to - from);
}

std::vector<PanelAxis::Tick> PanelAxis::ticks() const {
    std::vector<Tick> result;
    if (linear > 0.0) {
        for (int k = -4; k <= 4; ++k) {
            const double value = k == 0 ? 0.0 : std::copysign(linear * std::pow(10.0, std::abs(k) - 1), k);
            const double at = signedLog(value, linear);
            if (at >= lo && at <= hi) {
                result.push_back({value, tickLabel(value)});
            }
        }
        return result;
    }
    if (!log) {
        for (const PlotTick& t : ticksOf({lo, hi, from, to}, 6)) {
            result.push_back({t.value, t.label});
        }
        return result;
    }
    if (hasZero) {
        result.push_back({0.0, "0"});
    }
    const double span = hi - lo, bottom = lo + (hasZero ? kZeroRoom : 0.0);
    for (int decade = static_cast<int>(std::floor(lo)); decade <= static_cast<int>(std::ceil(hi)); ++decade) {
        for (double factor : factorsOf(span)) {
            const double at10 = decade + std::log10(factor);
            const bool wanted = factor == 1.0 ? (span < 6.0 || decade % 2 == 0) : span < 2.5;
            if (wanted && at10 >= bottom && at10 <= hi) {
                const double value = factor * std::pow(10.0, decade);
                result.push_back({value, tickLabel(value)});
            }
        }
    }
    return result;
}

PanelAxis panelAxis(const std::vector<double>& values, bool log, double from, double to) {
    PanelAxis axis = log ? logAxis(values) : linearAxis(values);
    axis.from = from;
    axis.to = to;
    return axis;
}

} // namespace fathom::profile
