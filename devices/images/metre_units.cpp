// SPDX-License-Identifier: Apache-2.0
#include "devices/images/metre_units.h"

#include "devices/recorded/source_options.h"

#include <algorithm>
#include <cmath>

namespace fathom {

double unitForMetres(double farthest) {
    constexpr double kFinestOfMetres = 1e-4, kMostUnits = 65000.0;
    const double unit = kFinestOfMetres * std::ceil(std::max(1.0, farthest / (kMostUnits * kFinestOfMetres)));
    return std::min(unit, kCoarsestUnit);
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
