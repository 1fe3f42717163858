// SPDX-License-Identifier: Apache-2.0
#include "apps/inspect/histogram_image.h"

#include "apps/output/image.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kPanel = 480.0, kBarsTop = 50.0, kBarsBottom = 300.0, kPanelMargin = 30.0; // [pixels]
constexpr Colour kInk{0.1, 0.1, 0.1}, kDepthInk{0.2, 0.35, 0.55};

// A saturated colour of this hue [degree].
Colour colourOfHue(double hue) {
    const auto channel = [&](double offset) {
        const double k = std::fmod(offset + hue / 30.0, 12.0);
        return 0.5 - 0.4 * std::clamp(std::min(k - 3.0, 9.0 - k), -1.0, 1.0);
    };
    return {channel(0.0), channel(8.0), channel(4.0)};
}

template <class BarColour>
void drawBars(const Image& image, double left, const std::vector<uint64_t>& counts, BarColour&& colour) {
    const double width =
        (kPanel - 2.0 * kPanelMargin) / static_cast<double>(std::max<size_t>(1, counts.size()));
    const uint64_t most = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
    for (size_t i = 0; i < counts.size() && most > 0; ++i) {
        const double height =
            (kBarsBottom - kBarsTop) * static_cast<double>(counts[i]) / static_cast<double>(most);
        image.box(left + kPanelMargin + width * static_cast<double>(i), kBarsBottom - height, width - 1.0,
                  height, colour(i));
    }
    image.line(left + kPanelMargin, kBarsBottom, left + kPanel - kPanelMargin, kBarsBottom, kInk, 1.0);
}

void drawLabel(const Image& image, double left, double share, const char* form, double value) {
    image.text(left + kPanelMargin + share * (kPanel - 2.0 * kPanelMargin), kBarsBottom + 18.0,
               printed(form, value), 13.0, kInk, Align::Centre);
}

} // namespace

void drawHistograms(const DepthBars& depth, const HueStudy* hues, const std::filesystem::path& file) {
    const Image image(static_cast<int>(hues != nullptr ? 2.0 * kPanel : kPanel), 340, {1.0, 1.0, 1.0});
    image.text(kPanelMargin, 30.0, "depth [m]; last bar: beyond", 15.0, kInk, Align::Left, true);
    drawBars(image, 0.0, depth.counts, [](size_t) { return kDepthInk; });
    const size_t bars = depth.counts.empty() ? 0 : depth.counts.size() - 1;
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
        image.text(kPanel + kPanelMargin, 30.0, "hue [degree] of clear colours", 15.0, kInk, Align::Left,
                   true);
        drawBars(image, kPanel, counts, [](size_t i) { return colourOfHue(kStep * static_cast<double>(i)); });
        for (size_t i = 0; i < HueStudy::kHues; i += 4) {
            drawLabel(image, kPanel, (static_cast<double>(i) + 0.5) / HueStudy::kHues, "%.0f",
                      kStep * static_cast<double>(i));
        }
    }
    image.writePng(file);
}

} // namespace fathom
