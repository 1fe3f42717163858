// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/guidance_points.h"

#include <algorithm>
#include <cmath>

namespace fathom::cloud {

namespace {

struct Pixel {
    uint32_t u, v;
};

// Points of one class as a picture; w = 0 where there is none.
class ClassPicture {
public:
    ClassPicture(const FixtureSet& set, uint32_t c, const PatchLayout& layout)
        : set_(set)
        , bit_(1u << c)
        , across_(layout.across)
        , width_(set.host.camera.depth.width)
        , height_(set.host.camera.depth.height) {}

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

    glm::vec4 at(uint32_t u, uint32_t v) const {
        const uint32_t slot = slotOfPixel(u, v, across_);
        const bool in = set_.device.listed.as<uint32_t>()[slot / 256] != 0 &&
                        (set_.device.masks.as<uint8_t>()[slot] & bit_) != 0;
        return in ? set_.device.points.as<glm::vec4>()[slot] : glm::vec4(0.0f);
    }

private:
    const FixtureSet& set_;
    uint32_t bit_, across_, width_, height_;
};

// Pixels connected to the seed, taken out of `open`.
std::vector<Pixel> flood(const ClassPicture& picture, Pixel seed, double edge, std::vector<uint8_t>& open) {
    std::vector<Pixel> part{seed};
    open[seed.v * picture.width() + seed.u] = 0;
    for (size_t i = 0; i < part.size(); ++i) {
        const Pixel p = part[i];
        const float z = picture.at(p.u, p.v).w;
        for (uint32_t k = 0; k < 9; ++k) {
            const uint32_t u = p.u + k % 3 - 1, v = p.v + k / 3 - 1; // wraps below zero: refused as too large
            if (u >= picture.width() || v >= picture.height() || open[v * picture.width() + u] == 0) {
                continue;
            }
            const float w = picture.at(u, v).w;
            if (edge > 0.0 && std::abs(w - z) > edge * std::min(w, z)) { // the same from either side
                continue;
            }
            open[v * picture.width() + u] = 0;
            part.push_back({u, v});
        }
    }
    return part;
}

std::vector<Pixel> largestPart(const ClassPicture& picture, const std::vector<Pixel>& all, double edge) {
    std::vector<uint8_t> open(static_cast<size_t>(picture.width()) * picture.height(), 0);
    for (const Pixel& p : all) {
        open[p.v * picture.width() + p.u] = 1;
    }
    std::vector<Pixel> best;
    for (const Pixel& p : all) {
        if (open[p.v * picture.width() + p.u] != 0) {
            std::vector<Pixel> part = flood(picture, p, edge, open);
            if (part.size() > best.size()) {
                best = std::move(part);
            }
        }
    }
    return best;
}

void trimFarthest(std::vector<dvec3>& points, double share) {
    const dvec3 mean = momentsOf(points).mean;
    std::stable_sort(points.begin(), points.end(), [&](const dvec3& a, const dvec3& b) {
        return glm::dot(a - mean, a - mean) < glm::dot(b - mean, b - mean);
    });
    points.resize(points.size() -
                  static_cast<size_t>(std::floor(share * static_cast<double>(points.size()))));
}

} // namespace

Moments chosenMoments(const FixtureSet& set, uint32_t c, const FixtureClass& fixture, double edge,
                      const PatchLayout& layout) {
    const ClassPicture picture(set, c, layout);
    std::vector<Pixel> pixels;
    for (uint32_t v = 0; v < picture.height(); ++v) {
        for (uint32_t u = 0; u < picture.width(); ++u) {
            if (picture.at(u, v).w != 0.0f) {
                pixels.push_back({u, v});
            }
        }
    }
    if (fixture.largestPart) {
        pixels = largestPart(picture, pixels, edge);
    }
    std::vector<dvec3> points;
    for (const Pixel& p : pixels) {
        points.emplace_back(picture.at(p.u, p.v));
    }
    if (fixture.trim > 0.0) {
        trimFarthest(points, fixture.trim);
    }
    return momentsOf(points);
}

} // namespace fathom::cloud
