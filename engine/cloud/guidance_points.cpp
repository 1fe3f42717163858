// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/guidance_points.h"

#include "engine/cloud/pixel_parts.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::cloud {

namespace {

// Collects the pixels of a class that have a point, in row-major order. Reads device memory once, and only in
// patches with guided pixels.
class PixelsOfClass {
public:
    PixelsOfClass(const FixtureSet& set, uint32_t c, const PatchLayout& layout)
        : words_(set.device.masks.as<uint32_t>())
        , points_(set.device.points.as<glm::vec4>())
        , bits_(0x01010101u << c)
        , width_(set.host.camera.depth.width)
        , height_(set.host.camera.depth.height) {
        const auto listed = set.device.listed.as<uint32_t>();
        std::vector<uint32_t> guided; // guided patches in a row of patches
        for (uint32_t down = 0; down < layout.down; ++down) {
            guided.clear();
            for (uint32_t patch = down * layout.across; patch < (down + 1) * layout.across; ++patch) {
                if ((listed[patch] & shared::kPatchGuided) != 0) {
                    guided.push_back(patch);
                }
            }
            for (uint32_t v = down * 16; v < std::min(down * 16 + 16, height_); ++v) {
                for (const uint32_t patch : guided) {
                    takeRow(patch, (patch - down * layout.across) * 16, v);
                }
            }
        }
    }

    std::vector<PartPixel> take() { return std::move(pixels_); }

private:
    // Takes one pixel row of the patch that begins in column u. A word holds four sub-patch pixels.
    void takeRow(uint32_t patch, uint32_t u, uint32_t v) {
        for (uint32_t sub = 0; sub < 4; ++sub) {
            const uint32_t slot = patch * 256 + (v % 16 / 4 * 4 + sub) * 16 + v % 4 * 4;
            const uint32_t word = words_[slot / 4] & bits_;
            for (uint32_t k = 0; word != 0 && k < 4; ++k) {
                const bool in = (word >> 8 * k & 0xff) != 0 && u + sub * 4 + k < width_;
                const float z = in ? points_[slot + k].w : 0.0f;
                if (z != 0.0f) {
                    pixels_.push_back({u + sub * 4 + k, v, slot + k, z});
                }
            }
        }
    }

    std::span<const uint32_t> words_;
    std::span<const glm::vec4> points_;
    uint32_t bits_, width_, height_;
    std::vector<PartPixel> pixels_;
};

// Of equally large parts, keeps the first.
void keepLargestPart(std::vector<PartPixel>& pixels, double edge) {
    const std::vector<uint32_t> parts = connectedParts(pixels, edge), sizes = partSizes(parts);
    const auto best = static_cast<uint32_t>(std::ranges::max_element(sizes) - sizes.begin());
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pixels.size(); ++i) {
        if (parts[i] == best) {
            pixels[kept++] = pixels[i];
        }
    }
    pixels.resize(kept);
}

// Of points at equal distance from the mean, keeps the first.
void trimFarthest(std::vector<dvec3>& points, double share) {
    const dvec3 mean = momentsOf(points).mean;
    std::vector<std::pair<double, uint32_t>> order(points.size());
    for (uint32_t i = 0; i < points.size(); ++i) {
        order[i] = {glm::dot(points[i] - mean, points[i] - mean), i};
    }
    const size_t kept =
        points.size() - static_cast<size_t>(std::floor(share * static_cast<double>(points.size())));
    if (kept == points.size()) {
        return;
    }
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(kept); // first point to drop
    std::nth_element(order.begin(), first, order.end());
    const std::pair<double, uint32_t> limit = *first;
    size_t to = 0;
    for (uint32_t i = 0; i < points.size(); ++i) {
        if (std::pair{glm::dot(points[i] - mean, points[i] - mean), i} < limit) {
            points[to++] = points[i];
        }
    }
    points.resize(to);
}

} // namespace

Moments chosenMoments(const FixtureSet& set, uint32_t c, const FixtureClass& fixture, double edge,
                      const PatchLayout& layout, size_t& untrimmed) {
    std::vector<PartPixel> pixels = PixelsOfClass(set, c, layout).take();
    if (fixture.largestPart) {
        keepLargestPart(pixels, edge);
    }
    const auto all = set.device.points.as<glm::vec4>();
    std::vector<dvec3> points;
    points.reserve(pixels.size());
    for (const PartPixel& p : pixels) {
        points.emplace_back(all[p.slot]);
    }
    untrimmed = points.size();
    if (fixture.trim > 0.0) {
        trimFarthest(points, fixture.trim);
    }
    return momentsOf(points);
}

} // namespace fathom::cloud
