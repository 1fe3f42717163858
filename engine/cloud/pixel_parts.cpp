// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/pixel_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::cloud {

namespace {

// Disjoint sets whose root is their first pixel.
class Parts {
public:
    explicit Parts(size_t pixels)
        : parent_(pixels) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    uint32_t root(uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void join(uint32_t i, uint32_t j) {
        const auto [first, last] = std::minmax({root(i), root(j)}); // by value
        parent_[last] = first;
    }

private:
    std::vector<uint32_t> parent_;
};

} // namespace

// Joins each pixel with the one to its left and the three above it.
std::vector<uint32_t> connectedParts(std::span<const PartPixel> pixels, double edge) {
    Parts parts(pixels.size());
    const auto joinNear = [&](uint32_t i, uint32_t j) { // symmetric in i and j
        const float z = pixels[i].z, w = pixels[j].z;
        if (edge == 0.0 || std::abs(w - z) <= edge * std::min(w, z)) {
            parts.join(i, j);
        }
    };
    uint32_t above = 0; // the first pixel not before the three above pixel i
    for (uint32_t i = 0; i < pixels.size(); ++i) {
        const auto [u, v, slot, z] = pixels[i];
        if (i > 0 && pixels[i - 1].v == v && pixels[i - 1].u + 1 == u) {
            joinNear(i, i - 1);
        }
        while (pixels[above].v + 1 < v || (pixels[above].v + 1 == v && pixels[above].u + 1 < u)) {
            ++above;
        }
        for (uint32_t j = above; pixels[j].v + 1 == v && pixels[j].u <= u + 1; ++j) {
            joinNear(i, j);
        }
    }
    std::vector<uint32_t> roots(pixels.size());
    for (uint32_t i = 0; i < pixels.size(); ++i) {
        roots[i] = parts.root(i);
    }
    return roots;
}

std::vector<uint32_t> partSizes(std::span<const uint32_t> parts) {
    std::vector<uint32_t> sizes(parts.size(), 0);
    for (const uint32_t part : parts) {
        ++sizes[part];
    }
    return sizes;
}

} // namespace fathom::cloud
