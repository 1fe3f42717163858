// SPDX-License-Identifier: Apache-2.0
#include "devices/images/metre_units.h"

#include "devices/recorded/source_options.h"
#include "engine/types/log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <optional>

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

double share(double part, double whole) {
    return whole > 0.0 ? part / whole : 0.0;
}

// The nearest point, without a few that are nearer than the bound where the others are beyond it; nothing
// where more are nearer. The farthest value is no other one: it may be a renderer's background.
struct FarPoint {
    double distance, beyond; // beyond: share of the points at this distance or farther
};

std::optional<FarPoint> nearestBeyond(const ValueSpan& seen, double bound) {
    constexpr double kFewOfOthers = 0.1; // share
    double near = 0.0, all = 0.0, before = 0.0;
    for (const ValueOctave& octave : seen.octaves) {
        near += octave.least >= bound ? 0.0 : octave.count; // an octave without values has none nearer
        all += octave.count;
    }
    if (near == 0.0 && all > 0.0) {
        return FarPoint{seen.nearest, 1.0};
    }
    if (near >= kFewOfOthers * (all - seen.atFarthest)) {
        return std::nullopt;
    }
    for (const ValueOctave& octave : seen.octaves) {
        if (before + octave.count > kFewOfOthers * all) {
            return FarPoint{octave.least, 1.0 - share(before, all)};
        }
        before += octave.count;
    }
    return std::nullopt;
}

} // namespace

void ValueOctave::add(const ValueOctave& other) {
    least = std::min(least, other.least);
    largest = std::max(largest, other.largest);
    count += other.count;
}

void ValueSpan::takeEnds(double least, double largest, double atLargest) {
    nearest = std::min(nearest, least);
    atFarthest = largest > farthest ? atLargest : atFarthest + (largest == farthest ? atLargest : 0.0);
    farthest = std::max(farthest, largest);
}

void ValueSpan::add(double value) {
    if (value > 0.0 && std::isfinite(value)) {
        constexpr int kMiddle = 32, kLast = 63; // 2^-32 to 2^31: depths in metres to micrometres
        octaves[static_cast<size_t>(std::clamp(std::ilogb(value) + kMiddle, 0, kLast))].add(
            {value, value, 1.0});
        takeEnds(value, value, 1.0);
    }
}

void ValueSpan::add(const ValueSpan& other) {
    for (size_t i = 0; i < octaves.size(); ++i) {
        octaves[i].add(other.octaves[i]);
    }
    takeEnds(other.nearest, other.farthest, other.atFarthest);
}

ValueSpan ValueSpan::scaled(double factor) const {
    ValueSpan span{factor * nearest, factor * farthest, octaves, atFarthest};
    for (ValueOctave& octave : span.octaves) {
        octave.least *= factor;
        octave.largest *= factor;
    }
    return span;
}

double ValueSpan::farthestWithin(double bound) const {
    double within = 0.0;
    for (const ValueOctave& octave : octaves) {
        within = octave.largest <= bound ? std::max(within, octave.largest) : within;
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

std::string metresWarning(const std::string& file, const ValueSpan& seen) {
    constexpr double kUnlikelyDistance = 50.0; // [m]
    const std::optional<FarPoint> far = nearestBeyond(seen, kUnlikelyDistance);
    if (!far) {
        return "";
    }
    const auto likely =
        std::ranges::find_if(kValueUnits, [&](const auto& unit) { return far->distance < unit.below; });
    const bool all = far->beyond == 1.0, known = likely != kValueUnits.end();
    if (!all && !known) {
        return ""; // no unit, but a background
    }
    std::string text = all ? fmt::format("{}: the nearest point is at {:.4g} m", file, far->distance)
                           : fmt::format("{}: {:.3g} % of its points are at {:.4g} m or beyond", file,
                                         100.0 * far->beyond, far->distance);
    if (known) {
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
