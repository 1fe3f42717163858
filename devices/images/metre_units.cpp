// SPDX-License-Identifier: Apache-2.0
#include "devices/images/metre_units.h"

#include "devices/recorded/source_options.h"
#include "engine/types/log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>

namespace fathom {

namespace {

// With the unit of the first row whose bound is higher, the nearest point is 0.05 m to 50 m away.
struct ValueUnit {
    double below; // of the nearest value
    const char *name, *scale;
};
constexpr std::array kValueUnits{ValueUnit{200.0, "centimetres", "0.01"},
                                 ValueUnit{5e4, "millimetres", "0.001"},
                                 ValueUnit{5e7, "micrometres", "0.000001"}};

} // namespace

void ValueSpan::add(double value) {
    if (value > 0.0 && std::isfinite(value)) {
        nearest = std::min(nearest, value);
        farthest = std::max(farthest, value);
        constexpr int kMiddle = 32, kLast = 63; // 2^-32 to 2^31: depths in metres to micrometres
        double& octave = octaves[static_cast<size_t>(std::clamp(std::ilogb(value) + kMiddle, 0, kLast))];
        octave = std::max(octave, value);
    }
}

void ValueSpan::add(const ValueSpan& other) {
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
    std::ranges::transform(octaves, other.octaves, octaves.begin(),
                           [](double a, double b) { return std::max(a, b); });
}

ValueSpan ValueSpan::scaled(double factor) const {
    ValueSpan span{factor * nearest, factor * farthest, octaves};
    for (double& octave : span.octaves) {
        octave *= factor;
    }
    return span;
}

double ValueSpan::farthestWithin(double bound) const {
    double within = 0.0;
    for (const double octave : octaves) {
        within = octave <= bound ? std::max(within, octave) : within;
    }
    return within;
}

double unitForMetres(double farthest) {
    constexpr double kFinestOfMetres = 1e-4, kMaxUnits = 65000.0;
    const double unit = kFinestOfMetres * std::ceil(std::max(1.0, farthest / (kMaxUnits * kFinestOfMetres)));
    return std::min(unit, kCoarsestUnit);
}

double unitForMetres(const ValueSpan& seen, double ofInterest, double spare) {
    constexpr double kBackground = 65.0; // [m] up to here the unit is 1 mm or finer, as that of most cameras
    const bool open = std::isinf(ofInterest);
    const double bound = open ? kBackground : ofInterest;
    if (!(seen.nearest <= bound)) {
        return unitForMetres(spare * seen.farthest);
    }
    const double within = open ? seen.farthestWithin(bound) : 0.0;
    return unitForMetres(std::min(spare * (within > 0.0 ? within : seen.farthest), bound));
}

std::string metresWarning(const std::string& file, double nearest) {
    constexpr double kUnlikelyDistance = 50.0; // [m]
    if (!(nearest >= kUnlikelyDistance && std::isfinite(nearest))) {
        return "";
    }
    std::string text = fmt::format("{}: the nearest point is at {:.4g} m", file, nearest);
    const auto likely =
        std::ranges::find_if(kValueUnits, [&](const auto& unit) { return nearest < unit.below; });
    if (likely != kValueUnits.end()) {
        text +=
            fmt::format("; if its values are {}, put ,scale={} after its name", likely->name, likely->scale);
    }
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
