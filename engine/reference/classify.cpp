// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/classify.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::reference {

namespace {

constexpr double kRounding = 1e-9; // of a quotient or a sum in float64
constexpr double kMetres = 1e-6;   // float32 positions at 1 m
constexpr double kPixels = 1e-3;

bool within(double value, const std::optional<Band>& band) {
    return !band || (value >= band->lo - kRounding && value <= band->hi + kRounding);
}

bool hueWithin(double hue, const Band& band) {
    if (band.lo <= band.hi) {
        return within(hue, band);
    }
    return hue >= band.lo - kRounding || hue <= band.hi + kRounding; // the band wraps through 0
}

bool passesColour(const FixtureClass& f, uint32_t rgba) {
    const Hsl c = hslOf(rgba);
    return within(c.saturation, f.saturation) && within(c.lightness, f.lightness) &&
           (!f.hue || (!c.grey && hueWithin(c.hue, *f.hue)));
}

// A gate that everything passes needs no colour.
bool asksColour(const FixtureClass& f) {
    const auto cuts = [](const std::optional<Band>& b) { return b && (b->lo > 0.0 || b->hi < 1.0); };
    return f.hue || cuts(f.saturation) || cuts(f.lightness);
}

struct BoxTest {
    bool inside = true, unsure = false;
};

BoxTest testBox(const FixtureClass& f, const dvec3& p, double scale) {
    BoxTest t;
    if (!f.box) {
        return t;
    }
    for (int a = 0; a < 3; ++a) {
        t.inside = t.inside && p[a] >= f.box->min[a] - kRounding && p[a] <= f.box->max[a] + kRounding;
        const double apart = std::min(std::abs(p[a] - f.box->min[a]), std::abs(p[a] - f.box->max[a]));
        t.unsure = t.unsure || apart < kMetres * scale;
    }
    return t;
}

BoxTest testRange(const FixtureClass& f, double range, double scale) {
    BoxTest t;
    if (f.range) {
        t.inside = within(range, f.range);
        t.unsure = std::min(std::abs(range - f.range->lo), std::abs(range - f.range->hi)) < kMetres * scale;
    }
    return t;
}

struct Seen {
    std::optional<uint32_t> colour; // empty: hidden or outside
    bool unsure = false;
};

Seen lookUp(const FrameView& view, const CellImage* cells, int u, int v, const dvec3& p) {
    const CameraInfo& camera = view.camera();
    if (!camera.hasColour) {
        return {};
    }
    if (cells == nullptr) {
        return {view.colour(u, v), false};
    }
    const dvec3 q = camera.colourTdepth.apply(p);
    if (q.z <= 0.0) {
        return {};
    }
    const NearestPixel at = nearestPixel(camera.colour, q, kPixels);
    if (at.u < 0 || at.v < 0 || at.u >= static_cast<int>(camera.colour.width) ||
        at.v >= static_cast<int>(camera.colour.height)) {
        return {std::nullopt, at.unsure};
    }
    const double front = cells->nearest[static_cast<uint32_t>(at.v) / cells->edge * cells->across +
                                        static_cast<uint32_t>(at.u) / cells->edge];
    const double limit = 1.02 * front + 0.005; // within 2 % and 5 mm counts as the same surface
    const bool unsure = at.unsure || std::abs(q.z - limit) < kMetres * std::max(1.0, q.z);
    return q.z > limit ? Seen{std::nullopt, unsure} : Seen{view.colour(at.u, at.v), unsure};
}

} // namespace

Hsl hslOf(uint32_t rgba) {
    const double r = (rgba & 255) / 255.0, g = (rgba >> 8 & 255) / 255.0, b = (rgba >> 16 & 255) / 255.0;
    const double hi = std::max({r, g, b}), lo = std::min({r, g, b}), chroma = hi - lo;
    Hsl c;
    c.lightness = 0.5 * (hi + lo);
    c.grey = chroma == 0.0;
    if (c.grey) {
        return c;
    }
    c.saturation = chroma / (1.0 - std::abs(2.0 * c.lightness - 1.0));
    const double sextant =
        hi == r ? (g - b) / chroma : (hi == g ? (b - r) / chroma + 2.0 : (r - g) / chroma + 4.0);
    c.hue = 60.0 * (sextant < 0.0 ? sextant + 6.0 : sextant);
    return c;
}

ClearColour withoutWater(uint32_t rgba, const dvec3& attenuation, double range) {
    constexpr double kGamma = 2.2, kSlack = 1e-3; // [bytes]
    ClearColour clear{rgba & 0xff000000u, false};
    for (int i = 0; i < 3; ++i) {
        const double stored = (rgba >> (8 * i) & 255) / 255.0;
        const double light = std::pow(stored, kGamma) * std::exp(attenuation[i] * range);
        const double byte = std::min(255.0, 255.0 * std::pow(light, 1.0 / kGamma));
        clear.rgba |= static_cast<uint32_t>(std::floor(byte + 0.5)) << (8 * i);
        clear.unsure = clear.unsure || std::abs(byte - std::floor(byte) - 0.5) < kSlack;
    }
    return clear;
}

ClassImage classify(const FrameView& view, const CellImage* cells) {
    const std::vector<const FixtureClass*> classes = pointClasses(view.scene());
    ClassImage out{std::vector<uint32_t>(view.pixels(), 0), std::vector<uint8_t>(view.pixels(), 0)};
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const double z = view.z(u, v);
            if (z == 0.0) {
                continue;
            }
            const dvec3 p = view.point(u, v, z), base = view.baseTcamera().apply(p);
            Seen seen = lookUp(view, cells, u, v, p);
            if (view.scene().attenuation && seen.colour) {
                const ClearColour clear =
                    withoutWater(*seen.colour, *view.scene().attenuation, glm::length(p));
                seen = {clear.rgba, seen.unsure || clear.unsure};
            }
            const size_t i = view.index(u, v);
            for (size_t c = 0; c < classes.size(); ++c) {
                const FixtureClass& f = *classes[c];
                const bool colour = !asksColour(f) || (seen.colour && passesColour(f, *seen.colour));
                const BoxTest box = testBox(f, base, std::max(1.0, z));
                const BoxTest range = testRange(f, glm::length(p), std::max(1.0, z));
                out.masks[i] |= colour && box.inside && range.inside ? 1u << c : 0u;
                if (box.unsure || range.unsure || (asksColour(f) && seen.unsure)) {
                    out.unsure[i] = 1;
                }
            }
        }
    }
    return out;
}

uint32_t validPixels(const FrameView& view) {
    uint32_t count = 0;
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            count += view.z(u, v) != 0.0 ? 1 : 0;
        }
    }
    return count;
}

} // namespace fathom::reference
