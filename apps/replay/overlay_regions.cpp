// SPDX-License-Identifier: Apache-2.0
// The forbidden regions in overlay.png: tinted and hatched silhouettes, their outlines, and their source
// points.
#include "apps/output/silhouette.h"
#include "apps/replay/overlay_layers.h"

#include <algorithm>
#include <cmath>

namespace fathom::overlay {

namespace {

uint32_t blend(uint32_t below, Colour colour, double alpha) {
    const auto channel = [&](int shift, double value) {
        const double under = below >> shift & 0xffu;
        return static_cast<uint32_t>(std::lround(under + alpha * (255.0 * value - under))) << shift;
    };
    return 0xff000000u | channel(16, colour.r) | channel(8, colour.g) | channel(0, colour.b);
}

// Coverage 0..1 of the pixel at `along` by a hatch line. Lines are at 45 degrees with edges softened over one
// pixel.
double hatchAt(int along, double period, double width) {
    const double inPeriod = std::fmod(along + 1e6 * period, period);
    const double distance = std::min(inPeriod, period - inPeriod);
    return std::clamp(0.5 * width + 0.5 - distance, 0.0, 1.0);
}

void tint(const Canvas& canvas, const RegionMasks& masks) {
    const int width = canvas.view.width(), height = canvas.view.height();
    const double period = 15.0 * canvas.size, line = 2.2 * canvas.size;
    canvas.image.beginPixels();
    for (int v = 0; v < height; ++v) {
        uint32_t* row = canvas.image.row(v);
        const size_t first = static_cast<size_t>(v) * static_cast<size_t>(width);
        for (int u = 0; u < width; ++u) {
            const size_t i = first + static_cast<size_t>(u);
            if (masks.seen[i] != 0) {
                row[u] = blend(row[u], kRegion, 0.22 + 0.26 * hatchAt(u + v, period, line));
            } else if (masks.held[i] != 0) {
                row[u] = blend(row[u], kRegion, 0.10 + 0.26 * hatchAt(u - v, period, line));
            }
        }
    }
    canvas.image.endPixels();
}

void outline(const Canvas& canvas, const std::vector<uint8_t>& mask, bool dashed) {
    constexpr size_t kMin = 24; // [pixels] shorter outlines are ignored
    tracePath(canvas, traceOutline(mask, canvas.view.width(), canvas.view.height(), kMin));
    strokeOnShade(canvas, kRegion, 2.4, dashed);
}

// One dot per point. Writes pixels directly, because there may be as many points as pixels.
void points(const Canvas& canvas, const HostFixtures& set) {
    const int width = canvas.view.width(), height = canvas.view.height();
    const int dot = std::max(1, static_cast<int>(std::lround(1.6 * canvas.size)));
    canvas.image.beginPixels();
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        const auto pixel = canvas.view.ofBase(regionCentre(set, i));
        if (!pixel || !(pixel->x >= 0.0 && pixel->y >= 0.0 && pixel->x < width && pixel->y < height)) {
            continue;
        }
        const int u0 = std::max(0, static_cast<int>(pixel->x) - dot / 2);
        const int v0 = std::max(0, static_cast<int>(pixel->y) - dot / 2);
        for (int v = v0; v < std::min(height, v0 + dot); ++v) {
            for (int u = u0; u < std::min(width, u0 + dot); ++u) {
                uint32_t& target = canvas.image.row(v)[u];
                target = blend(target, {1.0, 0.55, 0.48}, 0.6);
            }
        }
    }
    canvas.image.endPixels();
}

} // namespace

void drawRegions(const Canvas& canvas, const HostFixtures& set) {
    if (set.spheres.size() == 0) {
        return;
    }
    const RegionMasks masks = regionMasks(canvas.view, set);
    tint(canvas, masks);
    points(canvas, set);
    if (masks.anyHeld) {
        outline(canvas, masks.held, true);
    }
    outline(canvas, masks.seen, false);
}

} // namespace fathom::overlay
