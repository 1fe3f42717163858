// SPDX-License-Identifier: Apache-2.0
#include "apps/output/plot_axis.h"

#include "engine/types/number_text.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

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
        ticks.push_back({k * step, printed("%.*f", decimals, k * step + 0.0)}); // + 0.0: never "-0"
    }
    return ticks;
}

std::string shortNumber(double value) {
    const double size = std::abs(value);
    if (size != 0.0 && (size < 0.1 || size >= 1e5)) {
        return printed("%.3g", value);
    }
    const int whole = size < 1.0 ? 0 : static_cast<int>(std::floor(std::log10(size))) + 1;
    return printed("%.*f", std::clamp(4 - std::max(whole, 1), 0, 3), value);
}

std::string roundNumber(double value) {
    return significant(value, 4);
}

} // namespace fathom
