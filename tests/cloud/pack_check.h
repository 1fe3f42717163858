// SPDX-License-Identifier: Apache-2.0
// Compares the host's spheres with the slots that are kept for a tree, one by one and in order.
#pragma once

#include "tests/support/cloud_rig.h"

#include <doctest/doctest.h>

namespace fathom::testing {

struct Expected {
    std::vector<reference::RegionSphere> spheres;
    std::vector<uint32_t> sources;
};

// Every sphere of the slots, ordered by patch, layer and slot.
inline Expected inOrder(const CloudRig& rig) {
    const std::vector<reference::RegionSphere> layers[2] = {
        rig.slotSpheres(false),
        rig.plan().hold ? rig.slotSpheres(true) : std::vector<reference::RegionSphere>()};
    const auto width = static_cast<uint32_t>(rig.width()),
               pixels = width * static_cast<uint32_t>(rig.height());
    const uint32_t across = rig.cycle().layout().across;
    std::vector<uint32_t> pixelOf(rig.cycle().layout().slots(), ~0u);
    for (uint32_t p = 0; p < pixels; ++p) {
        pixelOf[slotOfPixel(p % width, p / width, across)] = p;
    }
    Expected all;
    for (size_t place = 0; place < 2 * pixelOf.size(); ++place) {
        const size_t layer = place / 256 % 2, slot = place / 512 * 256 + place % 256;
        const uint32_t pixel = pixelOf[slot];
        if (pixel == ~0u || layers[layer].empty() || layers[layer][pixel].radius < 0.0) {
            continue;
        }
        all.spheres.push_back(layers[layer][pixel]);
        all.sources.push_back(pixel + (layer != 0 ? pixels : 0));
    }
    return all;
}

// Tests both forms, although a device uses one. With a tree the slots are kept in addition to packed runs.
inline CloudRig::Change packing(bool pack) {
    return [pack](Plan& plan) {
        plan.pack = plan.byPixel = plan.tree = pack;
        plan.memoryTexels = plan.memoryTexels && !pack;
    };
}

inline void checkPacked(const CloudRig& rig) {
    const Expected all = inOrder(rig);
    const RegionSpheres& host = rig.host().spheres;
    REQUIRE(host.size() == all.spheres.size());
    CHECK((rig.counters().packedWords > 0) == (rig.plan().pack && !all.spheres.empty()));
    size_t wrong = 0;
    for (size_t i = 0; i < all.spheres.size(); ++i) {
        const reference::RegionSphere& s = all.spheres[i];
        const dvec3 centre = dvec3(host.x[i], host.y[i], host.z[i]) + rig.origin();
        wrong += centre != s.centre || host.radius[i] != s.radius || host.source[i] != all.sources[i] ||
                 (s.cls >= 0 && host.fixture[i] != static_cast<uint8_t>(s.cls));
    }
    CHECK(wrong == 0);
}

} // namespace fathom::testing
