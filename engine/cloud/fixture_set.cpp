// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/fixture_set.h"

#include "engine/cloud/frame_params.h"
#include "shaders/shared/query_params.h"

namespace fathom::cloud {

void FixtureSet::describeDevice(const Scene& scene, uint64_t frozenVersion, const gpu::Device::At& written) {
    rows.clear();
    for (const uint32_t row : classRows(scene)) {
        rows.push_back(scene.fixtures[row].frozen ? kStill : static_cast<int>(row));
    }
    stillVersion = frozenVersion;
    landed = written;
}

FixtureSet::Place FixtureSet::placeOf(const PatchLayout& layout, uint32_t slot, uint32_t pointClass) const {
    const uint32_t layer = slot & 3u, at = slot >> 2;
    if (layer == shared::kLayerStill) {
        return {host.spheres.source[stillFrom + at], host.spheres.fixture[stillFrom + at]};
    }
    const auto width = static_cast<uint32_t>(host.camera.depth.width);
    const auto pixels = static_cast<uint32_t>(host.camera.depth.pixels());
    const uint32_t patch = at / shared::kBlockSlots;
    const uint32_t u = patch % layout.across * 16 + (at >> 2 & 12) + (at & 3);
    const uint32_t v = patch / layout.across * 16 + (at >> 4 & 12) + (at >> 2 & 3);
    return {v * width + u + layer * pixels, rows[pointClass]};
}

} // namespace fathom::cloud
