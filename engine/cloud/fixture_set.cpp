// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/fixture_set.h"

#include "engine/cloud/frame_params.h"
#include "shaders/shared/query_params.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom::cloud {

namespace {

// [m] of the finite spheres; 0 without any.
float largestOf(const RegionSpheres& s) {
    float largest = 0.0f;
    for (size_t i = 0; i < s.size(); ++i) {
        const bool finite = std::isfinite(s.x[i] + s.y[i] + s.z[i] + s.radius[i]);
        largest = finite ? std::max(largest, s.radius[i]) : largest;
    }
    return largest;
}

} // namespace

void FixtureSet::describeDevice(const Scene& scene, const FrozenClasses& classes,
                                const gpu::Device::TimelinePoint& written) {
    fixtureOfClass.clear();
    for (const uint32_t fixture : classFixtures(scene)) {
        fixtureOfClass.push_back(scene.fixtures[fixture].frozen ? kFrozen : static_cast<int>(fixture));
    }
    frozen = classes.spheres();
    frozenVersion = classes.version();
    completed = written;
    float largest = frozen ? largestOf(*frozen) : 0.0f;
    const auto& counters = device.counters.as<shared::FrameCounters>()[0];
    for (size_t c = 0; c < fixtureOfClass.size(); ++c) {
        largest = fixtureOfClass[c] == kFrozen
                      ? largest
                      : std::max(largest, std::bit_cast<float>(counters.largestRadius[c]));
    }
    largestRadius = double{largest};
}

PatchBits FixtureSet::forbidden(const PatchLayout& layout) const {
    return {device.listed.as<uint32_t>(), device.bits.as<uint32_t>(), layout.across};
}

FixtureSet::Place FixtureSet::placeOf(const PatchLayout& layout, uint32_t slot, uint32_t pointClass) const {
    const uint32_t layer = slot & 3u, at = slot >> 2;
    if (layer == shared::kLayerFrozen) {
        return {frozen->source[at], frozen->fixture[at]};
    }
    const auto width = static_cast<uint32_t>(host.camera.depth.width);
    const auto pixels = static_cast<uint32_t>(host.camera.depth.pixels());
    const uint32_t patch = at / shared::kBlockSlots;
    const uint32_t u = patch % layout.across * 16 + (at >> 2 & 12) + (at & 3);
    const uint32_t v = patch / layout.across * 16 + (at >> 4 & 12) + (at >> 2 & 3);
    return {v * width + u + layer * pixels, fixtureOfClass[pointClass]};
}

} // namespace fathom::cloud
