// SPDX-License-Identifier: Apache-2.0
#include "apps/output/plot_axis.h"

#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fathom {

double roundStep(double range, int most) {
    const double least = range / most;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least * (1.0 - 1e-9)) {
            return factor * power;
        }
    }
    return 10.0 * power;
}

std::vector<PlotTick> ticksOf(const PlotAxis& axis, int most) {
    const double step = roundStep(axis.hi - axis.lo, most);
    const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
    std::vector<PlotTick> ticks;
    const double first = std::ceil(axis.lo / step - 1e-9);
    const double last = std::floor(axis.hi / step + 1e-9);
    for (double k = first; k <= last; k += 1.0) {
        char label[48];
        std::snprintf(label, sizeof label, "%.*f", decimals, k * step + 0.0); // + 0.0: never "-0"
        ticks.push_back({k * step, label});
    }
    return ticks;
}

std::string shortNumber(double value) {
    char text[48];
    const double size = std::abs(value);
    if (size != 0.0 && (size < 1e-4 || size >= 1e5)) {
        std::snprintf(text, sizeof text, "%.3g", value);
        return text;
    }
    const int whole = size < 1.0 ? 0 : static_cast<int>(std::floor(std::log10(size))) + 1;
    std::snprintf(text, sizeof text, "%.*f", std::clamp(4 - std::max(whole, 1), 0, 3), value);
    if (size != 0.0 && size < 0.1) {
        std::snprintf(text, sizeof text, "%.3g", value);
    }
    return text;
}

std::string roundNumber(double value) {
    return significant(value, 4);
}

} // namespace fathom
