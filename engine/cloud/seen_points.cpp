// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/seen_points.h"

#include "engine/contact/clones.h"

namespace fathom::cloud {

namespace {

// Column and row of a slot's pixel in its patch (shaders/lib/slots.glsl).
uint32_t acrossOf(uint32_t slot) {
    return (slot >> 2 & 12) + (slot & 3);
}
uint32_t downOf(uint32_t slot) {
    return (slot >> 4 & 12) + (slot >> 2 & 3);
}

// One row of [R | t].
float moved(const glm::vec4& row, float px, float py, float pz) {
    return row.x * px + row.y * py + row.z * pz + row.w;
}

FATHOM_CLONES void toPoints(const uint16_t* slots, size_t n, const float* depths, const float* column,
                            const float* row, const glm::vec4* rows, float* __restrict x, float* __restrict y,
                            float* __restrict z) noexcept {
    const glm::vec4 toX = rows[0], toY = rows[1], toZ = rows[2];
    for (size_t i = 0; i < n; ++i) {
        const float pz = depths[i], px = column[acrossOf(slots[i])] * pz, py = row[downOf(slots[i])] * pz;
        x[i] = moved(toX, px, py, pz);
        y[i] = moved(toY, px, py, pz);
        z[i] = moved(toZ, px, py, pz);
    }
}

// rays: from the patch's first pixel on.
FATHOM_CLONES void toPointsByTable(const uint16_t* slots, size_t n, const float* depths,
                                   const glm::vec2* rays, uint32_t width, const glm::vec4* rows,
                                   float* __restrict x, float* __restrict y, float* __restrict z) noexcept {
    const glm::vec4 toX = rows[0], toY = rows[1], toZ = rows[2];
    for (size_t i = 0; i < n; ++i) {
        const glm::vec2& ray = rays[downOf(slots[i]) * width + acrossOf(slots[i])];
        const float pz = depths[i], px = ray.x * pz, py = ray.y * pz;
        x[i] = moved(toX, px, py, pz);
        y[i] = moved(toY, px, py, pz);
        z[i] = moved(toZ, px, py, pz);
    }
}

} // namespace

std::vector<glm::vec2> raysOf(const Intrinsics& lens) {
    std::vector<glm::vec2> rays;
    rays.reserve(lens.pixels());
    for (uint32_t v = 0; v < lens.height; ++v) {
        for (uint32_t u = 0; u < lens.width; ++u) {
            rays.emplace_back(lens.ray(u, v));
        }
    }
    return rays;
}

SeenPoints::SeenPoints(const Intrinsics& lens, const PatchLayout& layout)
    : across_(layout.across)
    , width_(lens.width)
    , linear_(lens.pinhole()) {
    if (linear_) {
        column_.resize(size_t{layout.across} * 16);
        row_.resize(size_t{layout.down} * 16);
    } else {
        rays_ = raysOf(lens);
    }
}

void SeenPoints::setFrame(const shared::FrameParams& params) {
    frame_ = params;
    for (size_t u = 0; u < column_.size(); ++u) {
        column_[u] = (static_cast<float>(u) - params.lens.z) * params.steps.x;
    }
    for (size_t v = 0; v < row_.size(); ++v) {
        row_[v] = (static_cast<float>(v) - params.lens.w) * params.steps.y;
    }
}

void SeenPoints::put(uint32_t patch, std::span<const uint16_t> slots, const float* depths, float* x, float* y,
                     float* z) const noexcept {
    const size_t u = size_t{patch % across_} * 16, v = size_t{patch / across_} * 16;
    if (linear_) {
        toPoints(slots.data(), slots.size(), depths, &column_[u], &row_[v], frame_.baseTcamera, x, y, z);
    } else {
        toPointsByTable(slots.data(), slots.size(), depths, &rays_[v * width_ + u], width_,
                        frame_.baseTcamera, x, y, z);
    }
}

} // namespace fathom::cloud
