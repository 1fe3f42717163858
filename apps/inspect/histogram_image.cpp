// SPDX-License-Identifier: Apache-2.0
#include "apps/inspect/histogram_image.h"

#include "apps/output/image.h"
#include "apps/output/plot_axis.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace fathom {

namespace {

constexpr double kPanel = 510.0, kBarsTop = 50.0, kBarsBottom = 300.0; // [pixels]
constexpr double kTitleLeft = 14.0, kPanelMargin = 60.0, kRightMargin = 30.0,
                 kBarsWidth = kPanel - kPanelMargin - kRightMargin;
constexpr Colour kInk{0.1, 0.1, 0.1}, kDepthInk{0.2, 0.35, 0.55}, kGridInk{0.87, 0.87, 0.87};

// A saturated colour of this hue [degree].
Colour colourOfHue(double hue) {
    const auto channel = [&](double offset) {
        const double k = std::fmod(offset + hue / 30.0, 12.0);
        return 0.5 - 0.4 * std::clamp(std::min(k - 3.0, 9.0 - k), -1.0, 1.0);
    };
    return {channel(0.0), channel(8.0), channel(4.0)};
}

// Lines at round shares of `all`, up to the highest bar.
void drawShares(const Image& image, double left, uint64_t most, uint64_t all) {
    const double highest = 100.0 * static_cast<double>(most) / static_cast<double>(all); // [%]
    for (const PlotTick& tick : ticksOf({0.0, highest, kBarsBottom, kBarsTop}, 4)) {
        const double y = kBarsBottom - (kBarsBottom - kBarsTop) * tick.value / highest;
        image.line(left + kPanelMargin, y, left + kPanel - kRightMargin, y, kGridInk, 1.0);
        image.text(left + kPanelMargin - 6.0, y + 4.5, tick.label + " %", 13.0, kInk, Align::Right);
    }
}

template <class BarColour>
void drawBars(const Image& image, double left, const std::vector<uint64_t>& counts, BarColour&& colour) {
    const double width = kBarsWidth / static_cast<double>(std::max<size_t>(1, counts.size()));
    const uint64_t most = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
    if (most > 0) {
        drawShares(image, left, most, std::accumulate(counts.begin(), counts.end(), uint64_t{0}));
    }
    for (size_t i = 0; i < counts.size() && most > 0; ++i) {
        const double height =
            (kBarsBottom - kBarsTop) * static_cast<double>(counts[i]) / static_cast<double>(most);
        image.box(left + kPanelMargin + width * static_cast<double>(i), kBarsBottom - height, width - 1.0,
                  height, colour(i));
    }
    image.line(left + kPanelMargin, kBarsBottom, left + kPanel - kRightMargin, kBarsBottom, kInk, 1.0);
}

void drawLabel(const Image& image, double left, double share, const char* form, double value) {
    image.text(left + kPanelMargin + share * kBarsWidth, kBarsBottom + 18.0, printed(form, value), 13.0, kInk,
               Align::Centre);
}

} // namespace

void drawHistograms(const DepthBars& depth, const HueStudy* hues, const std::filesystem::path& file) {
    const Image image(static_cast<int>(hues != nullptr ? 2.0 * kPanel : kPanel), 340, {1.0, 1.0, 1.0});
    const size_t bars = depth.counts.empty() ? 0 : depth.counts.size() - 1;
    const double last = depth.low + depth.width * static_cast<double>(bars);
    image.text(kTitleLeft, 30.0,
               "measured pixels by depth [m]" +
                   (bars > 0 ? printed("; last bar: %.2f m and more", last) : ""),
               15.0, kInk, Align::Left, true);
    drawBars(image, 0.0, depth.counts, [](size_t) { return kDepthInk; });
    for (size_t i = 0; i <= bars && bars > 0; i += 3) {
        drawLabel(image, 0.0, static_cast<double>(i) / static_cast<double>(bars + 1), "%.2f",
                  depth.low + depth.width * static_cast<double>(i));
    }
    if (hues != nullptr) {
        constexpr double kStep = 360.0 / HueStudy::kHues;
        std::vector<uint64_t> counts;
        for (size_t i = 0; i < HueStudy::kHues; ++i) {
            counts.push_back(hues->count(i));
        }
        image.text(kPanel + kTitleLeft, 30.0, "clear colours by hue [degree]", 15.0, kInk, Align::Left, true);
        drawBars(image, kPanel, counts, [](size_t i) { return colourOfHue(kStep * static_cast<double>(i)); });
        for (size_t i = 0; i < HueStudy::kHues; i += 4) {
            drawLabel(image, kPanel, (static_cast<double>(i) + 0.5) / HueStudy::kHues, "%.0f",
                      kStep * static_cast<double>(i));
        }
    }
    image.writePng(file);
}

} // namespace fathom
