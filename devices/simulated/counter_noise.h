// SPDX-License-Identifier: Apache-2.0
// Noise as a pure function of counters: the same numbers in any order and on any thread.
#pragma once

#include <array>
#include <cstdint>

namespace fathom {

// Purpose of a random number; different purposes use independent numbers.
enum class NoisePurpose : uint32_t { Depth = 0, Flying = 2, Colour, Snow, Texture };

// 64 well-mixed bits of (seed, frame, index, purpose): three rounds of the splitmix64 finaliser (Steele, Lea,
// Flood, OOPSLA 2014).
inline uint64_t counterBits(uint64_t seed, uint32_t frame, uint32_t index, NoisePurpose purpose) noexcept {
    const auto mix = [](uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return x ^ (x >> 31);
    };
    const uint64_t stream = mix(seed + 0x9e3779b97f4a7c15ull * (static_cast<uint64_t>(purpose) + 1));
    return mix(mix(stream + frame * 0x9e3779b97f4a7c15ull) ^ (uint64_t{index} * 0xd1342543de82ef95ull + 1));
}

// [0, 1) of the upper or lower half.
inline float upperUniform(uint64_t bits) noexcept {
    return static_cast<float>(bits >> 40) * 0x1p-24f;
}
inline float lowerUniform(uint64_t bits) noexcept {
    return static_cast<float>(bits & 0xffffffu) * 0x1p-24f;
}

// Standard normal numbers from 20 random bits by a table of quantiles: zero mean, unit variance, cut at 3.3
// sigma.
class NormalTable {
public:
    NormalTable();
    float operator()(uint32_t bits20) const noexcept {
        const uint32_t bin = (bits20 >> 10) & 1023u;
        const float share = static_cast<float>(bits20 & 1023u) * 0x1p-10f;
        return edges_[bin] + share * (edges_[bin + 1] - edges_[bin]);
    }

    // The middle of the bin alone, from 10 random bits: coarse but quick.
    float coarse(uint32_t bits10) const noexcept { return middles_[bits10 & 1023u]; }

private:
    std::array<float, 1024> middles_;
    std::array<float, 1025> edges_;
};

} // namespace fathom
