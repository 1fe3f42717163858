// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/sphere_columns.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <bit>

namespace fathom::cloud {

namespace {

constexpr uint32_t kEveryClass = (1u << shared::kMaxClasses) - 1;
static_assert(shared::kMaxClasses <= 8); // `classOf` has three bits per layer; runs have bytes

// The indices of the set bits of a byte, lowest first; later entries are unused.
constexpr std::array<std::array<uint8_t, 8>, 256> bitsOfBytes() {
    std::array<std::array<uint8_t, 8>, 256> out{};
    for (size_t byte = 0; byte < 256; ++byte) {
        for (size_t bit = 0, n = 0; bit < 8; ++bit) {
            if ((byte >> bit & 1) != 0) {
                out[byte][n++] = static_cast<uint8_t>(bit);
            }
        }
    }
    return out;
}
constexpr auto kBitsOfBytes = bitsOfBytes();

FATHOM_CLONES void toColumns(const glm::vec4* spheres, size_t n, float* __restrict x, float* __restrict y,
                             float* __restrict z, float* __restrict radius) noexcept {
    for (size_t i = 0; i < n; ++i) {
        x[i] = spheres[i].x;
        y[i] = spheres[i].y;
        z[i] = spheres[i].z;
        radius[i] = spheres[i].w;
    }
}

// Writes eight entries per byte, however many bits are set: `places` has eight spare entries at the end.
FATHOM_CLONES void toPlaces(const uint32_t* bits, uint32_t words, uint16_t* __restrict places) noexcept {
    for (uint32_t word = 0; word < words; ++word) {
        for (uint32_t k = 0; bits[word] != 0 && k < 4; ++k) {
            const uint32_t byte = bits[word] >> 8 * k & 255;
            const std::array<uint8_t, 8>& set = kBitsOfBytes[byte];
            const auto first = static_cast<uint16_t>(word * 32 + k * 8);
            for (size_t j = 0; j < 8; ++j) {
                places[j] = static_cast<uint16_t>(first + set[j]);
            }
            places += std::popcount(byte);
        }
    }
}

// Row-major pixel indices in a patch whose first pixel is `corner`. Held points are numbered from the end of
// the image on.
FATHOM_CLONES void toSources(const uint16_t* places, size_t n, uint32_t corner, uint32_t width,
                             uint32_t pixels, uint32_t* __restrict source) noexcept {
    for (size_t i = 0; i < n; ++i) {
        const uint32_t p = places[i];
        const uint32_t across = (p >> 2 & 12) + (p & 3), down = (p >> 4 & 12) + (p >> 2 & 3);
        source[i] = corner + down * width + across + (p >> 8) * pixels;
    }
}

FATHOM_CLONES void grow(float* __restrict radius, size_t n, const uint8_t* steps, float step) noexcept {
    for (size_t i = 0; i < n; ++i) {
        radius[i] += static_cast<float>(steps[i]) * step;
    }
}

} // namespace

SphereColumns::SphereColumns(FixtureSet& set, const std::vector<uint32_t>& fixtures,
                             const PatchLayout& layout, const SeenPoints* seen, bool hold)
    : set_(set)
    , seen_(seen)
    , words_(hold ? 16 : 8)
    , across_(layout.across)
    , width_(set.host.camera.depth.width)
    , pixels_(static_cast<uint32_t>(set.host.camera.depth.pixels())) {
    std::ranges::transform(fixtures, fixtures_.begin(), [](uint32_t i) { return static_cast<uint8_t>(i); });
}

void SphereColumns::put(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept {
    Places places;
    toPlaces(spheres.places, words_, places.data());
    const uint32_t corner = (patch / across_ * width_ + patch % across_) * 16;
    toSources(places.data(), spheres.n(), corner, width_, pixels_, &set_.host.spheres.source[first]);
    putCentres(patch, first, spheres, places);
    putClasses(first, spheres, places);
    if (spheres.steps != nullptr) {
        grow(&set_.host.spheres.radius[first], spheres.seen, spheres.steps, seen_->step());
    }
}

void SphereColumns::putCentres(uint32_t patch, size_t first, const PatchSpheres& spheres,
                               const Places& places) noexcept {
    RegionSpheres& out = set_.host.spheres;
    const size_t depths = spheres.depths != nullptr ? spheres.seen : 0, whole = first + depths;
    if (depths > 0) {
        seen_->put(patch, {places.data(), depths}, spheres.depths, &out.x[first], &out.y[first],
                   &out.z[first]);
    }
    if (spheres.n() > depths) {
        toColumns(spheres.whole, spheres.n() - depths, &out.x[whole], &out.y[whole], &out.z[whole],
                  &out.radius[whole]);
    }
}

// Writes the classes and, where spheres are given as depths, the radii.
void SphereColumns::putClasses(size_t first, const PatchSpheres& spheres, const Places& places) noexcept {
    uint8_t* const fixture = &set_.host.spheres.fixture[first];
    float* const radius = &set_.host.spheres.radius[first];
    const uint32_t depths = spheres.depths != nullptr ? spheres.seen : 0;
    counts_.all += spheres.n();
    ++counts_.patches;
    for (uint32_t bits = spheres.classes & kEveryClass; bits != 0; bits &= bits - 1) {
        ++counts_.patchesOfClass[static_cast<size_t>(std::countr_zero(bits))];
    }
    if (std::has_single_bit(spheres.classes)) { // true for most patches
        const auto only = static_cast<size_t>(std::countr_zero(spheres.classes));
        counts_.ofClass[only] += spheres.n();
        std::fill_n(fixture, spheres.n(), fixtures_[only]);
        std::fill_n(radius, depths, depths > 0 ? seen_->radiusOf(only) : 0.0f);
        return;
    }
    const std::array fixtures = fixtures_; // a copy: byte writes may alias the member
    for (uint32_t i = 0; i < spheres.n(); ++i) {
        const size_t pointClass = spheres.classOf[places[i] & 255] >> (places[i] >> 8) * 4 & 7u;
        ++counts_.ofClass[pointClass];
        fixture[i] = fixtures[pointClass];
        if (i < depths) {
            radius[i] = seen_->radiusOf(pointClass);
        }
    }
}

} // namespace fathom::cloud
