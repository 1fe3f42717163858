// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/sphere_run.h"

#include "engine/contact/clones.h"

#include <bit>

namespace fathom::cloud {

namespace {

// Splits words into 24 bits of offset from `base` and 8 bits of growth steps.
FATHOM_CLONES void unpackDepths(const uint32_t* words, size_t n, uint32_t base, float* __restrict z,
                                uint8_t* __restrict steps) noexcept {
    for (size_t i = 0; i < n; ++i) {
        z[i] = std::bit_cast<float>(base + (words[i] >> 8));
        steps[i] = static_cast<uint8_t>(words[i]);
    }
}

} // namespace

PatchSpheres SphereRun::take(const uint32_t* words, uint32_t n, uint32_t mark,
                             const uint32_t* places) noexcept {
    const uint32_t grown = mark & shared::kRunGrown >> 16, wide = mark & shared::kRunWide >> 16;
    PatchSpheres s;
    for (uint32_t word = 0; word < 8; ++word) {
        s.seen += static_cast<uint32_t>(std::popcount(places[word]));
    }
    s.held = n - s.seen;
    s.places = places;
    s.classes = mark & 0xff;
    if (depths_ && grown != 0 && wide == 0) {
        unpackDepths(words + 1, s.seen, words[0], z_.data(), steps_.data());
        s.depths = z_.data();
        s.steps = steps_.data();
        words += s.seen + 1;
    } else if (depths_) {
        s.depths = reinterpret_cast<const float*>(words);
        words += s.seen;
        s.steps = grown != 0 ? reinterpret_cast<const uint8_t*>(words) : nullptr;
        words += grown != 0 ? (s.seen + 3) / 4 : 0;
    }
    s.whole = reinterpret_cast<const glm::vec4*>(words);
    return s;
}

} // namespace fathom::cloud
