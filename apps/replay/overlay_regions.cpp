// SPDX-License-Identifier: Apache-2.0
// The forbidden regions in overlay.png: tint and hatch inside their silhouette, its outline, the points they
// stand on.
#include "apps/replay/overlay_layers.h"
#include "apps/replay/silhouette.h"

#include <algorithm>
#include <cmath>

namespace fathom::overlay {

namespace {

struct RegionMasks {
    std::vector<uint8_t> seen, held; // held: where no seen region is
    bool anyHeld = false;
};

dvec3 centreOf(const Fixtures& set, size_t i) {
    return set.origin + dvec3(double{set.spheres.x[i]}, double{set.spheres.y[i]}, double{set.spheres.z[i]});
}

RegionMasks masksOf(const Canvas& canvas, const Fixtures& set) {
    const uint32_t pixels = set.camera.depth.pixels();
    Silhouette seen(canvas.view), held(canvas.view);
    RegionMasks masks;
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        const bool isHeld = set.spheres.source[i] >= pixels;
        (isHeld ? held : seen).add(centreOf(set, i), double{set.spheres.radius[i]});
        masks.anyHeld = masks.anyHeld || isHeld;
    }
    masks.seen = seen.mask();
    masks.held = held.mask();
    for (size_t i = 0; i < masks.held.size(); ++i) {
        masks.held[i] = static_cast<uint8_t>(masks.held[i] & ~masks.seen[i] & 1);
    }
    return masks;
}

uint32_t blend(uint32_t below, Colour colour, double alpha) {
    const auto channel = [&](int shift, double value) {
        const double under = below >> shift & 0xffu;
        return static_cast<uint32_t>(std::lround(under + alpha * (255.0 * value - under))) << shift;
    };
    return 0xff000000u | channel(16, colour.r) | channel(8, colour.g) | channel(0, colour.b);
}

// 0..1: how much of the pixel at `along` lies on a line of the hatch; lines run at 45 degrees, softened by a
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
    constexpr size_t kLeast = 24; // specks of a few pixels are no region's edge
    cairo_t* cr = canvas.image.cr();
    for (const OutlineLine& line : traceOutline(mask, canvas.view.width(), canvas.view.height(), kLeast)) {
        cairo_move_to(cr, line.front().x, line.front().y);
        for (const glm::dvec2& point : line) {
            cairo_line_to(cr, point.x, point.y);
        }
    }
    strokeOnShade(canvas, kRegion, 2.4, dashed);
}

// A dot a point, set pixel by pixel: there may be as many as the picture has pixels.
void points(const Canvas& canvas, const Fixtures& set) {
    const int width = canvas.view.width(), height = canvas.view.height();
    const int dot = std::max(1, static_cast<int>(std::lround(1.6 * canvas.size)));
    canvas.image.beginPixels();
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        const auto pixel = canvas.view.ofBase(centreOf(set, i));
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

void drawRegions(const Canvas& canvas, const Fixtures& set) {
    if (set.spheres.size() == 0) {
        return;
    }
    const RegionMasks masks = masksOf(canvas, set);
    tint(canvas, masks);
    points(canvas, set);
    if (masks.anyHeld) {
        outline(canvas, masks.held, true);
    }
    outline(canvas, masks.seen, false);
}

} // namespace fathom::overlay
