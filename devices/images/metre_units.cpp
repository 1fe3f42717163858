// SPDX-License-Identifier: Apache-2.0
#include "devices/images/metre_units.h"

#include "devices/recorded/source_options.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace fathom {

void ValueSpan::add(double value) {
    if (value > 0.0 && std::isfinite(value)) {
        nearest = std::min(nearest, value);
        farthest = std::max(farthest, value);
    }
}

void ValueSpan::add(const ValueSpan& other) {
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
}

double unitForMetres(double farthest) {
    constexpr double kFinestOfMetres = 1e-4, kMaxUnits = 65000.0;
    const double unit = kFinestOfMetres * std::ceil(std::max(1.0, farthest / (kMaxUnits * kFinestOfMetres)));
    return std::min(unit, kCoarsestUnit);
}

double unitForMetres(const ValueSpan& seen, double ofInterest) {
    const double most = 1.5 * seen.farthest;
    return unitForMetres(seen.nearest <= ofInterest ? std::min(most, ofInterest) : most);
}

std::string doubtMetres(const std::string& file, double nearest) {
    constexpr double kDoubtful = 50.0; // [m]
    if (!(nearest >= kDoubtful && std::isfinite(nearest))) {
        return "";
    }
    const std::string text = fmt::format("{}: the nearest point is at {:.4g} m; if its values are "
                                         "millimetres, put ,scale=0.001 behind its name",
                                         file, nearest);
    log::warn("{}", text);
    return text;
}

uint16_t unitsOf(double value, double valuesPerUnit, uint64_t& beyond) {
    if (!(value > 0.0) || !std::isfinite(value)) {
        return 0;
    }
    const double units = std::round(value / valuesPerUnit);
    beyond += units > 65535.0 ? 1 : 0;
    return units > 65535.0 ? uint16_t{0} : static_cast<uint16_t>(units);
}

} // namespace fathom
