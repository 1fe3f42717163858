// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/sphere_columns.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <bit>

namespace fathom::cloud {

namespace {

constexpr size_t kPlaces = 512; // of a patch
constexpr uint32_t kEveryClass = (1u << shared::kMaxClasses) - 1;
static_assert(shared::kMaxClasses <= 8); // three bits of `classOf` a layer, a byte of a run

// The places of the bits of a byte, from the lowest on; what is beyond them does not matter.
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
        x[i] = spheres[i].x, y[i] = spheres[i].y, z[i] = spheres[i].z, radius[i] = spheres[i].w;
    }
}

// Pixels, row-major in the picture, of a patch whose first is `corner`; held points count on from the last
// pixel. The order in which spheres are collected is by pixel. Eight places at a time, two rows of four
// pixels, whatever is there; `source` has room for eight beyond the last.
FATHOM_CLONES void toSources(const uint32_t* places, uint32_t words, uint32_t corner, uint32_t width,
                             uint32_t pixels, uint32_t* __restrict source) noexcept {
    for (uint32_t word = 0; word < words; ++word) {
        const uint32_t first = corner + (word >> 3) * pixels + (word >> 1 & 3) * 4 * width + (word & 1) * 8;
        for (uint32_t k = 0; places[word] != 0 && k < 4; ++k) {
            const uint32_t byte = places[word] >> 8 * k & 255;
            const uint32_t base = first + (k >> 1) * 4 + (k & 1) * 2 * width;
            const std::array<uint8_t, 8>& bits = kBitsOfBytes[byte];
            for (size_t j = 0; j < 8; ++j) {
                source[j] = base + (bits[j] & 3) + (bits[j] >> 2) * width;
            }
            source += std::popcount(byte);
        }
    }
}

template <class Take> // (place)
void eachPlace(const uint32_t* places, uint32_t words, Take&& take) noexcept {
    for (uint32_t word = 0; word < words; ++word) {
        for (uint32_t bits = places[word]; bits != 0; bits &= bits - 1) {
            take(word * 32 + static_cast<uint32_t>(std::countr_zero(bits)));
        }
    }
}

} // namespace

SphereColumns::SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout,
                             bool hold)
    : set_(set)
    , words_(hold ? 16 : 8)
    , across_(layout.across)
    , width_(set.host.camera.depth.width)
    , pixels_(static_cast<uint32_t>(set.host.camera.depth.pixels())) {
    std::ranges::transform(rows, rows_.begin(), [](uint32_t row) { return static_cast<uint8_t>(row); });
}

void SphereColumns::put(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept {
    RegionSpheres& out = set_.host.spheres;
    toColumns(spheres.spheres, spheres.n, &out.x[first], &out.y[first], &out.z[first], &out.radius[first]);
    putSources(patch, first, spheres);
    putClasses(&out.fixture[first], spheres);
    if (!set_.keys.empty()) {
        eachPlace(spheres.places, words_, [&](uint32_t place) { set_.keys[first++] = patch * 512 + place; });
    }
}

// By way of memory of its own: what is written beyond the last is another thread's.
void SphereColumns::putSources(uint32_t patch, size_t first, const PatchSpheres& spheres) noexcept {
    std::array<uint32_t, kPlaces + 8> sources;
    const uint32_t corner = (patch / across_ * width_ + patch % across_) * 16;
    toSources(spheres.places, words_, corner, width_, pixels_, sources.data());
    std::copy_n(sources.data(), spheres.n, &set_.host.spheres.source[first]);
}

void SphereColumns::putClasses(uint8_t* fixture, const PatchSpheres& spheres) noexcept {
    counts_.all += spheres.n;
    ++counts_.patches;
    for (uint32_t bits = spheres.classes & kEveryClass; bits != 0; bits &= bits - 1) {
        ++counts_.patchesOfClass[static_cast<size_t>(std::countr_zero(bits))];
    }
    if (std::has_single_bit(spheres.classes)) { // as in most patches
        const auto only = static_cast<size_t>(std::countr_zero(spheres.classes));
        counts_.ofClass[only] += spheres.n;
        std::fill_n(fixture, spheres.n, rows_[only]);
        return;
    }
    const std::array rows = rows_; // a byte that is written might be any of the members otherwise
    eachPlace(spheres.places, words_, [&](uint32_t place) {
        const size_t pointClass = spheres.classOf[place & 255] >> (place >> 8) * 4 & 7u;
        ++counts_.ofClass[pointClass];
        *fixture++ = rows[pointClass];
    });
}

} // namespace fathom::cloud
