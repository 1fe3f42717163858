// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/frozen_classes.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

void copySphere(RegionSpheres& to, size_t at, const RegionSpheres& from, size_t i) {
    to.x[at] = from.x[i];
    to.y[at] = from.y[i];
    to.z[at] = from.z[i];
    to.radius[at] = from.radius[i];
    to.source[at] = from.source[i];
    to.fixture[at] = from.fixture[i];
}

} // namespace

FrozenClasses::Kept FrozenClasses::take(const Fixtures& set, uint32_t row) {
    Kept kept;
    kept.origin = set.origin;
    const uint32_t moved = 2u * set.camera.depth.pixels();
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        if (set.spheres.fixture[i] == row) {
            const size_t at = kept.spheres.size();
            kept.spheres.resize(at + 1);
            copySphere(kept.spheres, at, set.spheres, i);
            kept.spheres.source[at] += moved;
        }
    }
    const auto guidance = std::find_if(set.guidance.begin(), set.guidance.end(),
                                       [&](const GuidancePose& g) { return g.fixture == row; });
    if (guidance != set.guidance.end()) {
        kept.guidance = *guidance;
    }
    return kept;
}

size_t FrozenClasses::apply(Fixtures& set, const Scene& scene) {
    const auto frozen = [&](uint32_t row) {
        return row < scene.fixtures.size() && scene.fixtures[row].isPoints() && scene.fixtures[row].frozen;
    };
    version_ += std::erase_if(kept_, [&](const auto& kept) { return !frozen(kept.first); });
    for (uint32_t row = 0; row < scene.fixtures.size(); ++row) {
        if (frozen(row) && !kept_.contains(row)) {
            kept_.emplace(row, take(set, row));
            ++version_;
        }
    }
    if (kept_.empty()) {
        return set.spheres.size();
    }
    RegionSpheres& spheres = set.spheres;
    size_t at = 0;
    for (size_t i = 0; i < spheres.size(); ++i) {
        if (!kept_.contains(spheres.fixture[i])) {
            copySphere(spheres, at++, spheres, i);
        }
    }
    const size_t first = at;
    spheres.resize(at);
    for (const auto& [row, kept] : kept_) {
        const glm::vec3 shift(kept.origin - set.origin);
        spheres.resize(at + kept.spheres.size());
        for (size_t i = 0; i < kept.spheres.size(); ++i, ++at) {
            copySphere(spheres, at, kept.spheres, i);
            spheres.x[at] += shift.x;
            spheres.y[at] += shift.y;
            spheres.z[at] += shift.z;
        }
        for (GuidancePose& guidance : set.guidance) {
            guidance = guidance.fixture == row && kept.guidance ? *kept.guidance : guidance;
        }
    }
    return first;
}

} // namespace fathom::cloud
