// SPDX-License-Identifier: Apache-2.0
#include "apps/inspect/hue_study.h"

#include "engine/reference/classify.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <ostream>
#include <string>

namespace fathom {

namespace {

constexpr double kBarDegrees = 360.0 / HueStudy::kHues;
constexpr double kMinShare = 0.002; // of the counted pixels, for a row
constexpr double kMaxStars = 40.0;

// The level below which `share` of the counts lie.
template <size_t N>
double levelAt(const std::array<uint64_t, N>& counts, double share, bool upper) {
    const uint64_t all = std::accumulate(counts.begin(), counts.end(), uint64_t{0});
    auto left = static_cast<uint64_t>(share * static_cast<double>(all));
    size_t level = 0;
    for (; level + 1 < N && counts[level] <= left; ++level) {
        left -= counts[level];
    }
    return static_cast<double>(level + (upper ? 1 : 0)) / static_cast<double>(N);
}

} // namespace

void HueStudy::add(std::span<const uint32_t> colours) {
    all_ += colours.size();
    for (const uint32_t colour : colours) {
        const reference::Hsl hsl = reference::hslOf(colour);
        if (hsl.saturation < kMinSaturation || hsl.lightness < kDark || hsl.lightness > kBright) {
            continue;
        }
        Bar& bar = bars_[static_cast<size_t>(std::floor(hsl.hue / kBarDegrees + 0.5)) % kHues];
        const auto level = [](double value) {
            return std::min(kLevels - 1, static_cast<size_t>(value * static_cast<double>(kLevels)));
        };
        ++bar.count;
        ++bar.saturation[level(hsl.saturation)];
        ++bar.lightness[level(hsl.lightness)];
    }
}

uint64_t HueStudy::clear() const {
    return std::accumulate(bars_.begin(), bars_.end(), uint64_t{0},
                           [](uint64_t sum, const Bar& bar) { return sum + bar.count; });
}

void HueStudy::write(std::ostream& out) const {
    const auto counted = static_cast<double>(clear());
    const auto flags = out.flags();
    out << std::fixed << std::setprecision(1) << "hue       of the "
        << (all_ > 0 ? 100.0 * counted / static_cast<double>(all_) : 0.0)
        << " % of the pixels with saturation from " << std::setprecision(2) << kMinSaturation
        << " and lightness " << kDark << " to " << kBright << "\n";
    const auto longest = std::ranges::max_element(bars_, {}, &Bar::count);
    for (size_t i = 0; i < kHues; ++i) {
        const Bar& bar = bars_[i];
        if (bar.count == 0 || static_cast<double>(bar.count) < kMinShare * counted) {
            continue;
        }
        const auto stars = static_cast<size_t>(
            std::ceil(kMaxStars * static_cast<double>(bar.count) / static_cast<double>(longest->count)));
        const double middle = kBarDegrees * static_cast<double>(i);
        out << std::setprecision(1) << "  " << std::setw(5)
            << std::fmod(middle + 360.0 - 0.5 * kBarDegrees, 360.0) << ".." << std::setw(5)
            << middle + 0.5 * kBarDegrees << " deg  " << std::left << std::setw(static_cast<int>(kMaxStars))
            << std::string(stars, '#') << std::right << std::setprecision(2) << "  saturation "
            << levelAt(bar.saturation, 0.1, false) << ".." << levelAt(bar.saturation, 0.9, true)
            << ", lightness " << levelAt(bar.lightness, 0.1, false) << ".."
            << levelAt(bar.lightness, 0.9, true) << "\n";
    }
    out.flags(flags);
}

} // namespace fathom
